#include "scenes.h"

#include "support/cloth_world_cases.h"

#include "scenes.h"

#include "support/cloth_contact_cases.h"

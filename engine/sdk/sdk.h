// The whole SDK for plugin authors: C++20, headers only, over engine/abi. Guide: docs/plugins.md.
#pragma once

#include "sdk/body_fit.h"
#include "sdk/body_source.h"
#include "sdk/cloth.h"
#include "sdk/garment.h"
#include "sdk/parameters.h"
#include "sdk/part_labels.h"
#include "sdk/plugin.h"
#include "sdk/resizer.h"
#include "sdk/scan_guide.h"
#include "sdk/scanner.h"
#include "sdk/sensor.h"
#include "sdk/skinning.h"
#include "sdk/thread_pool.h"
#include "sdk/tool.h"
#include "sdk/truth.h"
#include "sdk/views.h"

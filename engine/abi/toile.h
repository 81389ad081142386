/* toile/abi/toile.h - the whole plugin boundary. */
#ifndef TOILE_ABI_TOILE_H
#define TOILE_ABI_TOILE_H
#include "base.h"
#include "body.h"
#include "body_fit.h"
#include "body_source.h"
#include "cloth.h"
#include "frame.h"
#include "garment.h"
#include "host.h"
#include "parameters.h"
#include "part_labels.h"
#include "plugin.h"
#include "resizer.h"
#include "scan_guide.h"
#include "scanner.h"
#include "sensor.h"
#include "skinning.h"
#include "tool.h"
#include "truth.h"
#endif

// Extension toile.scan_guide/1 for a scanner class P with
//     void guide(const toile_scan_template& rough);  // [worker]
// and `using Extensions = Kinds<ScanGuide>;`.
#pragma once

#include "abi/scan_guide.h"
#include "sdk/guard.h"
#include "sdk/structs.h"

namespace toile::sdk {

struct ScanGuide {
    static constexpr const char* id = TOILE_SCAN_GUIDE;

    template <class P>
    static toile_status guide(toile_instance* instance, const toile_scan_template* rough) noexcept {
        return guarded<P>(instance, [&](P& p) { p.guide(read_struct(rough, "template")); });
    }
    template <class P>
    static constexpr toile_scan_guide table{sizeof(toile_scan_guide), 0, &guide<P>};
};

} // namespace toile::sdk

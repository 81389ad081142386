// Kind toile.scanner/1: one camera, a person who moves a little while turning; extension
// toile.scan_guide/1.
#include "boundary/warp_scanner.h"
#include "sdk/plugin.h"
#include "sdk/scanner.h"

namespace {

namespace sdk = toile::sdk;

class TurntableScanner : public toile::boundary::WarpScanner<0> {
  public:
    static constexpr sdk::Info info{.id = "toile.turntable_scanner",
                                    .name = "A person who sways while turning, by a warped body",
                                    .version = "0.1.0",
                                    .vendor = "Toile"};
    using Kinds = sdk::Kinds<sdk::Scanner>;
    using Extensions = sdk::Kinds<sdk::Parameters, sdk::ScanGuide>;

    explicit TurntableScanner(sdk::Host host) : WarpScanner(host, "turntable") {}
};

} // namespace

TOILE_PLUGIN(turntable_scanner, TurntableScanner)

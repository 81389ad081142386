// Kind toile.scanner/1: one camera, a person who moves the limbs freely; extension
// toile.scan_guide/1.
#include "boundary/warp_scanner.h"
#include "sdk/plugin.h"
#include "sdk/scanner.h"

namespace {

namespace sdk = toile::sdk;

class ArticulatedScanner : public toile::boundary::WarpScanner<6> {
  public:
    static constexpr sdk::Info info{.id = "toile.articulated_scanner",
                                    .name = "A person who moves the limbs, part by part",
                                    .version = "0.1.0",
                                    .vendor = "Toile"};
    using Kinds = sdk::Kinds<sdk::Scanner>;
    using Extensions = sdk::Kinds<sdk::Parameters, sdk::ScanGuide>;

    explicit ArticulatedScanner(sdk::Host host) : WarpScanner(host, "articulated") {}
};

} // namespace

TOILE_PLUGIN(articulated_scanner, ArticulatedScanner)

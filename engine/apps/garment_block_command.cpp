#include "apps/garment_block_command.h"

#include "core/error.h"
#include "garment/block_package.h"

#include <cstdio>
#include <sstream>

namespace toile::apps {
namespace {

std::vector<garment::block::SizeOrder> read_sizes(const std::string& text) {
    std::vector<garment::block::SizeOrder> orders;
    std::istringstream list(text);
    for (std::string item; std::getline(list, item, ',');) {
        const std::size_t equals = item.find('=');
        if (equals == 0 || equals == std::string::npos || equals + 1 == item.size()) {
            throw UsageError("--sizes: '" + item + "' is not NAME=AVATAR, as in S=woman,L=man");
        }
        const std::string avatar = item.substr(equals + 1);
        orders.push_back(
            {item.substr(0, equals), std::make_shared<const body::BodyModel>(
                                         body::load_body_model(body::find_avatar(avatar)))});
    }
    return orders;
}

} // namespace

void make_block_package(const BlockOptions& options, const garment::PackageLimits& limits) {
    const auto orders = read_sizes(options.sizes);
    garment::block::Design design = garment::block::find_design(options.block);
    if (!options.id.empty()) design.id = options.id;
    design.girth_ease_m = options.girth_ease_m;
    const garment::GarmentPackage package = garment::block::make_block(design, orders);
    garment::write_package(package, options.out, true);
    for (const auto& size : package.sizes) {
        std::printf("size %s on %s: %zu vertices, %zu triangles\n", size.entry.name.c_str(),
                    size.entry.made_on.c_str(), size.simulation.positions.size(),
                    size.simulation.triangles.size());
    }
    const auto faults = garment::check_package(options.out, limits);
    if (!faults.empty()) {
        throw Error(options.out.string() + ": " + faults.front().text);
    }
    std::printf("written: %s\n", (options.out / "garment.json").string().c_str());
}

} // namespace toile::apps

#include "garment/block_package.h"

#include "core/error.h"
#include "garment/block_design.h"
#include "imaging/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace toile::garment::block {
namespace {

bool starts_with(const std::string& text, const std::string& prefix) {
    return text.compare(0, prefix.size(), prefix) == 0;
}

// Girths where the avatar does not state them.
double measurement(const BodyProbe& probe, const std::string& name) {
    const auto& known = probe.body().measurements;
    if (const auto at = known.find(name); at != known.end()) {
        return at->second;
    }
    using body::Joint;
    const double crotch = probe.joint(Joint::left_upper_leg).y();
    const double chest = probe.joint(Joint::chest).y();
    const double armpit = probe.armpit_height();
    const bool waist = name == "waist_girth";
    const double low = name == "bust_girth" ? chest : waist ? crotch + 0.12 : crotch - 0.05;
    const double high = name == "bust_girth" ? armpit : waist ? chest : crotch + 0.12;
    double best = waist ? 1e9 : 0.0;
    for (double y = low; y <= high; y += 0.01) {
        const double girth = probe.ring(y).girth();
        best = waist ? std::min(best, girth) : std::max(best, girth);
    }
    return best;
}

// Ranges that meet half way between neighbouring bodies; a measurement that does not grow from
// size to size tells nothing and is left out.
void add_charts(const Design& design, const std::span<const BodyProbe* const> probes,
                std::vector<SizeEntry>& sizes) {
    for (const std::string& name : design.chart) {
        std::vector<double> values;
        for (const BodyProbe* probe : probes) {
            values.push_back(measurement(*probe, name));
        }
        const bool grows = std::adjacent_find(values.begin(), values.end(), [](double a, double b) {
                               return b < a + 0.005;
                           }) == values.end();
        if (!grows && name == design.chart.front()) {
            throw Error("the bodies of the sizes must grow in " + name +
                        " from the first to the last");
        }
        if (!grows) {
            continue;
        }
        constexpr double kMargin = 0.08; // beyond the outermost bodies
        for (std::size_t i = 0; i < values.size(); ++i) {
            const auto centimetre = [](const double x) { return std::round(x * 100.0) / 100.0; };
            const double low = i == 0 ? values[i] - kMargin : 0.5 * (values[i - 1] + values[i]);
            const double high =
                i + 1 == values.size() ? values[i] + kMargin : 0.5 * (values[i] + values[i + 1]);
            sizes[i].chart[name] = {centimetre(low), centimetre(high)};
        }
    }
}

std::vector<std::uint8_t> held_vertices(const Design& design, const Assembly& assembly,
                                        const Pattern& pattern) {
    std::vector<std::uint8_t> held(assembly.vertex_count(), 0);
    for (std::size_t t = 0; t < assembly.triangles.size(); ++t) {
        const std::string& name = pattern.panels[assembly.triangle_panel[t]].name;
        if (!design.held_prefix.empty() && starts_with(name, design.held_prefix)) {
            for (const std::uint32_t v : assembly.triangles[t]) {
                held[v] = 1;
            }
        }
    }
    for (const auto& [panel, edge] : pattern.held) {
        for (const std::uint32_t v : edge_vertices(assembly, pattern, 0, panel, edge)) {
            held[v] = 1;
        }
    }
    return held;
}

// Held panels, then ring after ring of neighbours, each more loosely.
std::vector<float> pin_mask(const Design& design, const Assembly& assembly,
                            const std::span<const std::uint8_t> held) {
    std::vector<float> mask(held.size(), 0.0f);
    std::vector<bool> reached(held.begin(), held.end());
    for (std::size_t v = 0; v < mask.size(); ++v) {
        mask[v] = held[v] != 0 ? design.held_strengths.front() : 0.0f;
    }
    for (std::size_t ring = 1; ring < design.held_strengths.size(); ++ring) {
        std::vector<bool> next = reached;
        for (const Triangle& t : assembly.triangles) {
            if (reached[t[0]] || reached[t[1]] || reached[t[2]]) {
                for (const std::uint32_t v : t) {
                    mask[v] = next[v] || reached[v] ? mask[v] : design.held_strengths[ring];
                    next[v] = true;
                }
            }
        }
        reached = next;
    }
    return mask;
}

assets::Scene make_scene(const Design& design, const Pattern& pattern, const Assembly& assembly,
                         const SizedBlock& block) {
    assets::Scene scene;
    std::vector<RenderPart> parts;
    std::vector<bool> taken(pattern.panels.size(), false);
    for (const DesignPart& part : design.parts) {
        RenderPart& out = parts.emplace_back();
        out.name = part.name;
        out.turn_in_m = part.turn_in_m;
        for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
            for (const std::string& prefix : part.panel_prefixes) {
                if (!taken[p] && starts_with(pattern.panels[p].name, prefix)) {
                    out.panels.push_back(static_cast<std::uint16_t>(p));
                    taken[p] = true;
                }
            }
        }
        constexpr int kPixels = 256;
        FabricTile tile = make_fabric_tile(part.weave, kPixels);
        out.tile_m = tile.width_m;
        scene.textures.push_back({part.name + "_shade", std::move(tile.shade), false});
        scene.textures.push_back({part.name + "_normal", std::move(tile.normal), true});
    }
    for (const Colourway& colour : design.colours) {
        scene.variants.push_back(colour.name);
    }
    auto primitives =
        render_parts(assembly, pattern, block, parts, std::max(0.001, design.fabric.thickness_m));
    assets::Mesh mesh;
    mesh.name = design.id;
    for (std::size_t p = 0; p < primitives.size(); ++p) {
        for (const Colourway& colour : design.colours) {
            assets::Material material;
            material.name = parts[p].name + "_" + colour.name;
            const Vec3f linear = colour.srgb.unaryExpr(&imaging::linear_from_srgb);
            material.base_color << linear, 1.0f;
            material.roughness = 0.85f;
            material.sheen_color = Vec3f(0.04f, 0.04f, 0.04f) + 0.15f * linear;
            material.sheen_roughness = 0.6f;
            material.base_color_texture = static_cast<int>(2 * p);
            material.normal_texture = static_cast<int>(2 * p + 1);
            material.double_sided = true;
            primitives[p].variant_materials.push_back(static_cast<int>(scene.materials.size()));
            scene.materials.push_back(material);
        }
        primitives[p].material = primitives[p].variant_materials.front();
        mesh.primitives.push_back(std::move(primitives[p]));
    }
    scene.meshes.push_back(std::move(mesh));
    assets::Node node;
    node.name = design.id;
    node.mesh = 0;
    scene.nodes.push_back(node);
    return scene;
}

Manifest make_manifest(const Design& design) {
    Manifest m;
    m.id = design.id;
    m.version = "1.0.0";
    m.name = design.name;
    m.maker = "Toile";
    m.licence = "Apache-2.0";
    m.kind = design.kind;
    m.layer = design.layer;
    m.ease_m = design.ease_m;
    m.ease_class = design.ease_class;
    m.fabric = design.fabric;
    m.body_mask = design.body_mask;
    for (const Colourway& colour : design.colours) {
        Variant variant;
        variant.name = colour.name;
        variant.material_variant = colour.name;
        m.variants.push_back(variant);
    }
    return m;
}

// Names of the panels that a vertex belongs to.
std::string panels_at(const Pattern& pattern, const Assembly& assembly,
                      const std::uint32_t vertex) {
    std::string panels;
    for (std::size_t t = 0; t < assembly.triangles.size(); ++t) {
        const std::string name = "'" + pattern.panels[assembly.triangle_panel[t]].name + "'";
        const auto& corners = assembly.triangles[t];
        if (std::find(corners.begin(), corners.end(), vertex) != corners.end() &&
            panels.find(name) == std::string::npos) {
            panels += (panels.empty() ? "" : " and ") + name;
        }
    }
    return panels;
}

// Says why a garment does not hang, if it does not.
void check_drape(const Design& design, const Pattern& pattern, const Assembly& assembly,
                 const DrapeReport& report, const std::string& size) {
    const auto refuse = [&](const char* format, const double value, const std::string& rest,
                            const std::string& panel) {
        std::array<char, 96> text{};
        std::snprintf(text.data(), text.size(), format, value);
        throw DrapeRefused(design.id + ", size " + size + ": " + text.data() + rest, size,
                           design.drape, report, panel);
    };
    if (!std::isfinite(report.rms_speed) || !std::isfinite(report.worst_strain)) {
        refuse("the cloth blew up (%.0f)", 0.0, "", "");
    }
    if (report.dropped_m > 0.25) {
        refuse("fell off: it sank by %.2f m while it hung free", report.dropped_m, "", "");
    }
    if (report.worst_strain > design.drape.most_strain) {
        const std::string panel = panels_at(pattern, assembly, report.worst_edge);
        refuse("stretched by %.0f %% ", 100.0 * report.worst_strain,
               "where panel " + panel + " lies: a seam gapes there, or the panel is too small",
               panel);
    }
    if (report.rms_speed > design.drape.rest_m_s) {
        const std::string panel = panels_at(pattern, assembly, report.fastest);
        refuse("did not come to rest: it still moves at %.3f m/s", report.rms_speed,
               ", most at panel " + panel, panel);
    }
}

} // namespace

GarmentPackage make_block(const std::string& block, const std::span<const SizeOrder> sizes) {
    return make_block(find_design(block), sizes);
}

GarmentPackage make_block(const Design& design, const std::span<const SizeOrder> orders,
                          const WatchDrape& watch) {
    if (orders.empty()) {
        throw UsageError("block '" + design.id + "': no sizes");
    }
    std::vector<std::unique_ptr<BodyProbe>> probes;
    std::vector<const BodyProbe*> views;
    std::vector<Pattern> patterns;
    for (const SizeOrder& order : orders) {
        probes.push_back(std::make_unique<BodyProbe>(*order.body));
        views.push_back(probes.back().get());
        patterns.push_back(design.draft(*probes.back(), design.girth_ease_m));
    }
    GarmentPackage package;
    package.manifest = make_manifest(design);
    for (const SizeOrder& order : orders) {
        SizeEntry& entry = package.manifest.sizes.emplace_back();
        entry.name = order.name;
        entry.made_on = order.body->id;
        entry.mesh = design.id + "-" + order.name + ".glb";
    }
    add_charts(design, views, package.manifest.sizes);

    const Pattern& base = patterns[orders.size() / 2];
    const Assembly assembly = assemble(base, design.edge_m);
    const std::vector<std::uint8_t> held = held_vertices(design, assembly, base);

    for (std::size_t i = 0; i < orders.size(); ++i) {
        SizedBlock block = grade(assembly, patterns[i]);
        const DistanceField field(orders[i].body->rest, 0.008, 0.03);
        if (watch) watch(orders[i].name, "placed", block.positions, assembly.triangles);
        const DrapeReport report = drape(assembly, block, field, held, design.drape);
        if (watch) watch(orders[i].name, "draped", block.positions, assembly.triangles);
        check_drape(design, patterns[i], assembly, report, orders[i].name);
        GarmentSize size;
        size.entry = package.manifest.sizes[i];
        for (const Vec3d& p : block.positions) {
            size.simulation.positions.push_back(p.cast<float>());
        }
        size.simulation.triangles = assembly.triangles;
        size.material_coords = block.material_coords;
        size.render = make_scene(design, patterns[i], assembly, block);
        package.sizes.push_back(std::move(size));
    }
    if (!design.held_prefix.empty() || !base.held.empty()) {
        package.pins = pin_mask(design, assembly, held);
        PinGroup group;
        group.name = "waistband";
        group.mask = package.pins;
        package.manifest.pins.push_back(group);
    }
    return package;
}

} // namespace toile::garment::block

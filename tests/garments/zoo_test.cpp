// A zoo of bad garment packages: each is made from one sound package by one change, and each is
// refused with its own one-line error.
#include "assets/files.h"
#include "assets/zip.h"
#include "core/bytes.h"
#include "garment/package.h"
#include "support/garments.h"
#include "support/meshes.h"
#include "support/temporary_folder.h"

#include <cstring>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace toile::garment {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// A sound package in a folder of its own, and ways to spoil it.
struct Animal {
    test::TemporaryFolder outer;
    fs::path folder = outer / "skirt";
    fs::path target = folder; ///< what is loaded

    Animal() { write_package(test::small_package(), folder); }

    /// Only one avatar is known: 1.7 m tall.
    static PackageLimits limits() {
        PackageLimits out;
        out.body_of = [](const std::string& avatar) {
            if (avatar != "mannequin") throw Error("no avatar is called '" + avatar + "'");
            return test::box(Vec3f(-0.6f, 0.0f, -0.2f), Vec3f(0.6f, 1.7f, 0.2f));
        };
        return out;
    }

    static std::string text(const fs::path& file) {
        const auto bytes = read_bytes(file, 64u << 20);
        return {bytes.begin(), bytes.end()};
    }
    void replace(const std::string& from, const std::string& to) {
        std::string all = text(folder / "garment.json");
        const auto at = all.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        write_text(folder / "garment.json", all.replace(at, from.size(), to));
    }
    void json(const std::function<void(Json&)>& change) {
        Json j = Json::parse(text(folder / "garment.json"));
        change(j);
        write_text(folder / "garment.json", j.dump(1));
    }
    /// Changes the JSON chunk and the binary chunk of size S.
    void glb(const std::function<void(Json&, std::string&)>& change) {
        const std::string all = text(folder / "S.glb");
        std::uint32_t length = 0;
        std::memcpy(&length, all.data() + 12, 4);
        Json j = Json::parse(all.substr(20, length));
        std::string bin = all.substr(28 + length);
        change(j, bin);
        std::string head = j.dump();
        head.resize((head.size() + 3) / 4 * 4, ' ');
        const auto word = [](std::size_t v) {
            const auto w = static_cast<std::uint32_t>(v);
            std::string out(4, '\0');
            std::memcpy(out.data(), &w, 4);
            return out;
        };
        write_text(folder / "S.glb", "glTF" + word(2) + word(28 + head.size() + bin.size()) +
                                         word(head.size()) + "JSON" + head + word(bin.size()) +
                                         std::string("BIN\0", 4) + bin);
    }
    /// Writes the package anew from changed meshes.
    void meshes(const std::function<void(GarmentPackage&)>& change) {
        GarmentPackage package = test::small_package();
        change(package);
        write_package(package, folder);
    }
    void skinned() {
        meshes([](GarmentPackage& p) {
            for (GarmentSize& size : p.sizes) {
                size.skin.joints.assign(size.simulation.positions.size(), {0, 1, 0, 0});
                size.skin.weights.assign(size.simulation.positions.size(), {0.5f, 0.5f, 0, 0});
            }
        });
    }
    void zip(const std::function<void(assets::ZipContents&)>& change) {
        assets::ZipContents contents;
        for (const char* const name : {"garment.json", "S.glb", "M.glb"})
            contents[name] = read_bytes(folder / name, 64u << 20);
        change(contents);
        target = outer / "skirt.zip";
        assets::write_zip(contents, target);
    }
    void patch_zip(const std::string& from, const std::string& to) {
        std::string all = text(target);
        for (auto at = all.find(from); at != std::string::npos; at = all.find(from, at + 1))
            all.replace(at, from.size(), to);
        write_text(target, all);
    }
};

/// Byte offset of element 0 of an accessor in the binary chunk.
std::size_t offset_of(const Json& j, std::size_t accessor) {
    const Json& a = j.at("accessors").at(accessor);
    const Json& view = j.at("bufferViews").at(a.at("bufferView").get<std::size_t>());
    return view.value("byteOffset", std::size_t{0}) + a.value("byteOffset", std::size_t{0});
}
/// The simulation mesh's primitive.
Json& simulation(Json& j) {
    for (Json& mesh : j.at("meshes"))
        if (mesh.value("name", "") == "simulation") return mesh.at("primitives").at(0);
    throw Error("no simulation mesh");
}
std::size_t accessor(Json& j, const char* attribute) {
    return simulation(j).at("attributes").at(attribute).get<std::size_t>();
}
template <typename T>
void poke(std::string& bin, std::size_t offset, T value) {
    std::memcpy(bin.data() + offset, &value, sizeof(T));
}
/// The image of the render mesh as a file beside the mesh.
void external_image(Animal& a, const std::string& uri) {
    a.glb([&uri](Json& j, std::string&) {
        j.at("images").at(0).erase("bufferView");
        j.at("images").at(0).erase("mimeType");
        j.at("images").at(0)["uri"] = uri;
    });
}

struct Case {
    const char* name;
    FaultCode code;
    const char* part; ///< of the text
    std::function<void(Animal&)> spoil;
};

void scale_all(GarmentPackage& p, float factor) {
    for (GarmentSize& size : p.sizes) {
        for (Vec3f& x : size.simulation.positions)
            x *= factor;
        for (auto& primitive : size.render.meshes[0].primitives)
            for (Vec3f& x : primitive.positions)
                x *= factor;
        for (Vec2f& m : size.material_coords)
            m *= factor;
    }
}

std::vector<Case> manifest_cases() {
    using enum FaultCode;
    return {
        {"not_json", json, "not valid JSON at byte", [](Animal& a) { a.replace("\"id\"", "id"); }},
        {"key_twice", json, "'layer' stands twice",
         [](Animal& a) { a.replace("\"layer\": 1", "\"layer\": 1, \"layer\": 2"); }},
        {"unknown_key", json, "/colour: is not a known key",
         [](Animal& a) { a.json([](Json& j) { j["colour"] = "red"; }); }},
        {"unknown_fabric_key", json, "/fabric/strecth: is not a known key",
         [](Animal& a) { a.json([](Json& j) { j["fabric"]["strecth"] = 3; }); }},
        {"missing_key", json, "/licence: is missing",
         [](Animal& a) { a.json([](Json& j) { j.erase("licence"); }); }},
        {"missing_fabric", json, "/fabric: is missing",
         [](Animal& a) { a.json([](Json& j) { j.erase("fabric"); }); }},
        {"wrong_type", json, "/layer: must be a whole number",
         [](Animal& a) { a.json([](Json& j) { j["layer"] = "one"; }); }},
        {"newer_schema", schema, "update Toile",
         [](Animal& a) { a.json([](Json& j) { j["schema"] = 2; }); }},
        {"bad_id", value, "/id: must be 1 to 64 of",
         [](Animal& a) { a.json([](Json& j) { j["id"] = "T Shirt/.."; }); }},
        {"bad_version", value, "/version: must look like 1.0.0",
         [](Animal& a) { a.json([](Json& j) { j["version"] = "new"; }); }},
        {"fabric_nan", json, "not valid JSON",
         [](Animal& a) { a.replace("\"weight\": 180.0", "\"weight\": NaN"); }},
        {"fabric_infinite", json, "out of range",
         [](Animal& a) { a.replace("\"weight\": 180.0", "\"weight\": 1e999"); }},
        {"fabric_negative", value, "/fabric/shear: is -5, must lie between",
         [](Animal& a) { a.json([](Json& j) { j["fabric"]["shear"] = -5; }); }},
        {"fabric_in_kilograms", value, "0.18 kg/m2 is written 180",
         [](Animal& a) { a.json([](Json& j) { j["fabric"]["weight"] = 0.18; }); }},
        {"thickness_in_metres", value, "0.0005 m is written 0.5",
         [](Animal& a) { a.json([](Json& j) { j["fabric"]["thickness"] = 0.0005; }); }},
        {"ease_in_millimetres", value, "4 mm is written 0.004",
         [](Animal& a) { a.json([](Json& j) { j["ease"] = 4; }); }},
        {"ease_class_unknown", value, "/ease_class: 'snug' is no ease class",
         [](Animal& a) { a.json([](Json& j) { j["ease_class"] = "snug"; }); }},
        {"ease_class_of_no_region", value, "/ease_class/nose: is no region",
         [](Animal& a) { a.json([](Json& j) {
                             j["ease_class"] = {{"nose", "loose"}};
                         }); }},
        {"ease_class_of_nothing", value, "/ease_class: names no region",
         [](Animal& a) { a.json([](Json& j) { j["ease_class"] = Json::object(); }); }},
        {"ease_class_a_number", json,
         "/ease_class: ", [](Animal& a) { a.json([](Json& j) { j["ease_class"] = 4.5; }); }},
        {"chart_in_centimetres", value, "88 cm is written 0.88",
         [](Animal& a) {
             a.json([](Json& j) { j["sizes"][0]["chart"]["hip_girth"] = {{"body", 88}}; });
         }},
        {"chart_upside_down", value, "is larger than max",
         [](Animal& a) {
             a.json([](Json& j) {
                 j["sizes"][0]["chart"]["hip_girth"] = {{"min", 1}, {"max", 0.9}};
             });
         }},
        {"size_twice", duplicate, "'S' stands twice",
         [](Animal& a) { a.json([](Json& j) { j["sizes"][1]["name"] = "S"; }); }},
        {"no_sizes", value, "/sizes: needs at least one",
         [](Animal& a) { a.json([](Json& j) { j["sizes"] = Json::array(); }); }},
        {"absolute_path", unsafe_path, "is absolute",
         [](Animal& a) { a.json([](Json& j) { j["sizes"][0]["mesh"] = "/etc/passwd"; }); }},
        {"path_upwards", unsafe_path, "holds '../'",
         [](Animal& a) { a.json([](Json& j) { j["sizes"][0]["mesh"] = "../S.glb"; }); }},
        {"windows_path", unsafe_path, "backslash or a colon",
         [](Animal& a) { a.json([](Json& j) { j["sizes"][0]["mesh"] = "C:\\S.glb"; }); }},
        {"bad_colour", value, "must be a colour like",
         [](Animal& a) { a.json([](Json& j) { j["variants"][1]["base_color"] = "navy"; }); }},
        {"bad_body_part", value, "'tail' is not a body part",
         [](Animal& a) { a.json([](Json& j) { j["body_mask"] = {"tail"}; }); }},
        {"unknown_avatar", made_on, "/made_on: no avatar is called 'centaur'",
         [](Animal& a) { a.json([](Json& j) { j["made_on"] = "centaur"; }); }},
        {"apart_from_its_avatar", unit, "stands apart from the body it was made on",
         [](Animal& a) {
             a.meshes([](GarmentPackage& p) {
                 p.manifest.made_on = "mannequin";
                 for (GarmentSize& size : p.sizes)
                     for (Vec3f& x : size.simulation.positions)
                         x.y() += 1.05f;
             });
         }},
        {"pin_out_of_range", pins, "names vertex 99999, but the simulation mesh has 216",
         [](Animal& a) { a.json([](Json& j) { j["pins"][0]["vertices"][0] = 99999; }); }},
        {"pin_negative", pins, "must hold vertex indices only, not -1",
         [](Animal& a) { a.json([](Json& j) { j["pins"][0]["vertices"][0] = -1; }); }},
        {"pin_mask_short", pins, "has a mask of 2 numbers",
         [](Animal& a) {
             a.json([](Json& j) { j["pins"] = {{{"name", "waist"}, {"mask", {0.5, 1}}}}; });
         }},
        {"variant_unknown", variant, "has no material variant 'green'",
         [](Animal& a) {
             a.json([](Json& j) { j["variants"][0]["material_variant"] = "green"; });
         }},
    };
}

std::vector<Case> file_cases() {
    using enum FaultCode;
    return {
        {"no_package", not_found, "no such package",
         [](Animal& a) { a.target = a.outer / "no-skirt"; }},
        {"no_manifest", not_found, "a package has a garment.json at its top",
         [](Animal& a) { fs::remove(a.folder / "garment.json"); }},
        {"missing_mesh", missing_file, "'S.glb' does not exist",
         [](Animal& a) { fs::remove(a.folder / "S.glb"); }},
        {"mesh_is_a_folder", missing_file, "is not a regular file",
         [](Animal& a) {
             fs::remove(a.folder / "S.glb");
             fs::create_directory(a.folder / "S.glb");
         }},
        {"link_out", unsafe_path, "symbolic link that leaves the package",
         [](Animal& a) {
             fs::rename(a.folder / "S.glb", a.outer / "S.glb");
             fs::create_symlink(a.outer / "S.glb", a.folder / "S.glb");
         }},
        {"other_format", mesh_file, "a mesh must be .glb, .fbx or .obj",
         [](Animal& a) {
             fs::rename(a.folder / "S.glb", a.folder / "S.stl");
             a.json([](Json& j) { j["sizes"][0]["mesh"] = "S.stl"; });
         }},
        {"cut_off", mesh_file, "is cut off",
         [](Animal& a) { fs::resize_file(a.folder / "S.glb", 3000); }},
        {"empty_file", mesh_file, "is not a GLB file",
         [](Animal& a) { fs::resize_file(a.folder / "S.glb", 0); }},
        {"text_as_glb", mesh_file, "is not a GLB file",
         [](Animal& a) {
             write_text(a.folder / "S.glb", "a mesh, honestly, with many vertices\n");
         }},
        {"missing_thumbnail", missing_file, "'small.png' does not exist",
         [](Animal& a) { a.json([](Json& j) { j["thumbnail"] = "small.png"; }); }},
        {"thumbnail_upwards", unsafe_path, "holds '../'",
         [](Animal& a) { a.json([](Json& j) { j["thumbnail"] = "../small.png"; }); }},
        {"thumbnail_is_text", mesh_file, "/thumbnail: ",
         [](Animal& a) {
             write_text(a.folder / "small.png", "I am a picture");
             a.json([](Json& j) { j["thumbnail"] = "small.png"; });
         }},
        {"missing_texture", missing_file, "'red.png' does not exist",
         [](Animal& a) { external_image(a, "red.png"); }},
        {"texture_upwards", unsafe_path, "holds '../'",
         [](Animal& a) { external_image(a, "%2e%2e/red.png"); }},
        {"text_as_png", mesh_file, "red.png",
         [](Animal& a) {
             write_text(a.folder / "red.png", "I am a picture");
             external_image(a, "red.png");
         }},
        {"huge_texture", mesh_file, "red.png",
         [](Animal& a) {
             imaging::save_image({1, 1, {1, 2, 3, 255}}, a.folder / "red.png");
             std::string png = Animal::text(a.folder / "red.png");
             const std::string side("\0\1\x86\xa0", 4); // 100,000 pixels
             write_text(a.folder / "red.png", png.replace(16, 4, side).replace(20, 4, side));
             external_image(a, "red.png");
         }},
        {"missing_material_library", missing_file, "'skirt.mtl' does not exist",
         [](Animal& a) {
             write_text(a.folder / "S.obj",
                        "mtllib skirt.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
             a.json([](Json& j) { j["sizes"][0]["mesh"] = "S.obj"; });
         }},
        {"not_a_zip", archive, "skirt.zip",
         [](Animal& a) {
             a.target = a.outer / "skirt.zip";
             write_text(a.target, "PK? no");
         }},
        {"a_file_that_is_no_package", not_found, "a folder or a .zip, not this file",
         [](Animal& a) { a.target = a.folder / "S.glb"; }},
        {"zip_bomb", archive, "bomb.bin",
         [](Animal& a) {
             a.zip([](auto& c) { c["bomb.bin"] = std::vector<std::uint8_t>(48u << 20); });
         }},
        {"zip_upwards", archive, "..",
         [](Animal& a) {
             a.zip([](auto& c) { c["xx/evil.txt"] = {1, 2, 3}; });
             a.patch_zip("xx/evil.txt", "../evil.txt");
         }},
        {"zip_absolute", archive, "/evil.txt",
         [](Animal& a) {
             a.zip([](auto& c) { c["x/evil.txt"] = {1, 2, 3}; });
             a.patch_zip("x/evil.txt", "//evil.txt");
         }},
        {"zip_without_manifest", not_found, "garment.json at its top",
         [](Animal& a) { a.zip([](auto& c) { c.erase("garment.json"); }); }},
    };
}

std::vector<Case> mesh_cases() {
    using enum FaultCode;
    return {
        {"claims_a_gigabyte", mesh_file, "S.glb",
         [](Animal& a) {
             a.glb([](Json& j, std::string&) {
                 j["accessors"][accessor(j, "POSITION")]["count"] = 90'000'000;
             });
         }},
        {"nan_position", mesh_file, "S.glb",
         [](Animal& a) {
             a.glb([](Json& j, std::string& bin) {
                 poke(bin, offset_of(j, accessor(j, "POSITION")) + 12 * 7,
                      std::numeric_limits<float>::quiet_NaN());
             });
         }},
        {"index_out_of_range", mesh_file, "S.glb",
         [](Animal& a) {
             a.glb([](Json& j, std::string& bin) {
                 const auto at = simulation(j).at("indices").get<std::size_t>();
                 const bool small = j["accessors"][at]["componentType"] == 5123;
                 if (small)
                     poke<std::uint16_t>(bin, offset_of(j, at), 65000);
                 else
                     poke<std::uint32_t>(bin, offset_of(j, at), 65000);
             });
         }},
        {"node_cycle", mesh_file, "S.glb",
         [](Animal& a) {
             a.skinned();
             a.glb([](Json& j, std::string&) {
                 Json& nodes = j["nodes"];
                 for (std::size_t i = 0; i < nodes.size(); ++i)
                     if (nodes[i].value("name", "") == "leftHand")
                         for (std::size_t k = 0; k < nodes.size(); ++k)
                             if (nodes[k].value("name", "") == "leftUpperArm")
                                 nodes[i]["children"] = {k};
             });
         }},
        {"weights_zero", mesh_file, "S.glb",
         [](Animal& a) {
             a.skinned();
             a.glb([](Json& j, std::string& bin) {
                 const std::size_t at = offset_of(j, accessor(j, "WEIGHTS_0"));
                 for (std::size_t k = 0; k < 4; ++k)
                     poke(bin, at + 4 * k, 0.0f);
             });
         }},
        {"joint_out_of_range", mesh_file, "S.glb",
         [](Animal& a) {
             a.skinned();
             a.glb([](Json& j, std::string& bin) {
                 const std::size_t at = accessor(j, "JOINTS_0");
                 if (j["accessors"][at]["componentType"] == 5121)
                     poke<std::uint8_t>(bin, offset_of(j, at), 200);
                 else
                     poke<std::uint16_t>(bin, offset_of(j, at), 200);
             });
         }},
        {"two_meshes_without_a_name", no_simulation, "none is named 'simulation'",
         [](Animal& a) {
             a.glb([](Json& j, std::string&) {
                 for (const char* const list : {"nodes", "meshes"})
                     for (Json& item : j[list])
                         if (item.value("name", "") == "simulation") item["name"] = "cloth";
             });
         }},
        {"no_material_coordinates", material_coords, "has no texture coordinates",
         [](Animal& a) {
             a.glb([](Json& j, std::string&) { simulation(j)["attributes"].erase("TEXCOORD_0"); });
         }},
        {"material_without_area", material_coords, "have no area, first of triangle",
         [](Animal& a) {
             a.meshes([](GarmentPackage& p) {
                 for (Vec2f& m : p.sizes[0].material_coords)
                     m.y() = 0.25f;
             });
         }},
        {"material_in_texture_units", material_coords, "they must be in metres",
         [](Animal& a) {
             a.meshes([](GarmentPackage& p) {
                 for (Vec2f& m : p.sizes[0].material_coords)
                     m *= 10.0f;
             });
         }},
        {"not_manifold", topology, "not a manifold surface",
         [](Animal& a) {
             a.meshes([](GarmentPackage& p) {
                 auto& size = p.sizes[0];
                 size.simulation.triangles.push_back({0, 1, 100});
                 size.material_coords.insert(size.material_coords.end(),
                                             {Vec2f(0, 0), Vec2f(0.1f, 0), Vec2f(0, 0.1f)});
             });
         }},
        {"degenerate_triangle", mesh, "simulation mesh",
         [](Animal& a) {
             a.meshes([](GarmentPackage& p) {
                 auto& size = p.sizes[0];
                 size.simulation.positions[30] = size.simulation.positions[31];
             });
         }},
        {"centimetres", unit, "looks like centimetres",
         [](Animal& a) { a.meshes([](GarmentPackage& p) { scale_all(p, 100.0f); }); }},
        {"millimetres", unit, "looks like millimetres",
         [](Animal& a) { a.meshes([](GarmentPackage& p) { scale_all(p, 1000.0f); }); }},
        {"decimetres", unit, "looks like decimetres",
         [](Animal& a) { a.meshes([](GarmentPackage& p) { scale_all(p, 10.0f); }); }},
        {"stands_apart", unit, "stands apart from the body",
         [](Animal& a) {
             a.meshes([](GarmentPackage& p) {
                 for (GarmentSize& size : p.sizes)
                     for (Vec3f& x : size.simulation.positions)
                         x.z() += 5.0f;
             });
         }},
        {"sizes_differ", size_topology, "share one topology",
         [](Animal& a) {
             a.meshes([](GarmentPackage& p) {
                 p.sizes[1] = test::tube_size("M", 0.22f, 0.5f, 1.0f, 26);
             });
         }},
        {"render_far_off", render_far, "off the simulation mesh, at most 50.0 mm",
         [](Animal& a) {
             a.meshes([](GarmentPackage& p) {
                 for (Vec3f& x : p.sizes[0].render.meshes[0].primitives[0].positions)
                     x.x() += 0.3f;
             });
         }},
    };
}

void expect_refused(const Case& c) {
    SCOPED_TRACE(c.name);
    Animal animal;
    c.spoil(animal);
    const Faults faults = check_package(animal.target, Animal::limits());
    ASSERT_FALSE(faults.empty()) << "nothing was found wrong";
    try {
        static_cast<void>(load_package(animal.target, Animal::limits()));
        ADD_FAILURE() << "it was loaded";
    } catch (const PackageError& e) {
        const std::string text = e.what();
        EXPECT_EQ(e.code(), c.code) << fault_name(e.code()) << ": " << text;
        EXPECT_NE(text.find(c.part), std::string::npos) << text;
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        EXPECT_NE(text.find("skirt"), std::string::npos) << "does not name the package: " << text;
        EXPECT_EQ(text, faults.front().text);
    }
}

TEST(Zoo, TheSoundPackageIsSound) {
    Animal a;
    EXPECT_TRUE(check_package(a.target).empty());
    a.skinned();
    EXPECT_TRUE(check_package(a.target).empty());
    a.zip([](auto&) {});
    EXPECT_TRUE(check_package(a.target).empty());
    const auto package = load_package(a.target);
    EXPECT_EQ(package->sizes.size(), 2u);
}

TEST(Zoo, Manifests) {
    for (const Case& c : manifest_cases())
        expect_refused(c);
}
TEST(Zoo, Files) {
    for (const Case& c : file_cases())
        expect_refused(c);
}
TEST(Zoo, Meshes) {
    for (const Case& c : mesh_cases())
        expect_refused(c);
}

TEST(Zoo, PackedTwiceGivesEqualBytesAndLoads) {
    const Animal a;
    pack_package(a.folder, a.outer / "a.zip");
    pack_package(a.folder, a.outer / "b.zip");
    EXPECT_EQ(read_bytes(a.outer / "a.zip", 64u << 20), read_bytes(a.outer / "b.zip", 64u << 20));
    EXPECT_EQ(load_package(a.outer / "a.zip")->manifest.id, "test-skirt");
}

} // namespace
} // namespace toile::garment

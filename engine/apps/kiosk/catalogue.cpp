#include "apps/kiosk/catalogue.h"

#include "core/bytes.h"
#include "core/error.h"

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

namespace toile::apps::kiosk {
namespace {

namespace fs = std::filesystem;

std::uint64_t mixed(std::uint64_t hash, std::uint64_t value) {
    // FNV-1a over eight bytes.
    for (int i = 0; i < 8; ++i) {
        hash ^= (value >> (8 * i)) & 0xffu;
        hash *= 0x100000001b3u;
    }
    return hash;
}

std::uint64_t file_stamp(std::uint64_t hash, const fs::directory_entry& entry) {
    std::error_code code;
    for (const char c : entry.path().filename().string())
        hash = mixed(hash, static_cast<unsigned char>(c));
    hash = mixed(hash, entry.file_size(code));
    return mixed(
        hash, static_cast<std::uint64_t>(entry.last_write_time(code).time_since_epoch().count()));
}

constexpr std::size_t kMostManifest = 16u << 20;

Article article_of(const garment::Manifest& manifest, const fs::path& source, std::uint64_t stamp) {
    Article out;
    out.source = source;
    out.stamp = stamp;
    out.id = manifest.id;
    out.name = manifest.name;
    for (const garment::SizeEntry& size : manifest.sizes)
        out.sizes.push_back(size.name);
    for (const garment::Variant& variant : manifest.variants)
        out.colours.push_back(variant.name);
    if (!manifest.thumbnail.empty() && fs::is_directory(source))
        out.thumbnail = source / manifest.thumbnail;
    return out;
}

bool is_garment(const fs::path& path) {
    return path.extension() == ".zip" || fs::is_regular_file(path / "garment.json");
}

} // namespace

std::vector<fs::path> garment_sources(const std::vector<std::string>& names,
                                      const fs::path& folder) {
    std::vector<fs::path> out;
    for (const std::string& name : names)
        out.push_back(!folder.empty() && fs::exists(folder / name) ? folder / name
                                                                   : garment::find_garment(name));
    if (!names.empty()) return out;
    if (folder.empty()) {
        for (const std::string& id : garment::list_garments())
            out.push_back(garment::find_garment(id));
    } else {
        std::error_code code;
        for (const auto& entry : fs::directory_iterator(folder, code))
            if (is_garment(entry.path())) out.push_back(entry.path());
        if (code) throw Error(folder.string() + ": cannot be read: " + code.message());
    }
    std::sort(out.begin(), out.end());
    if (out.empty())
        throw Error((folder.empty() ? std::string("the data folders") : folder.string()) +
                    ": there is no garment; see docs/garments.md");
    return out;
}

std::uint64_t article_stamp(const fs::path& source) {
    constexpr std::uint64_t kBasis = 0xcbf29ce484222325u;
    std::error_code code;
    if (!fs::is_directory(source, code)) {
        const fs::directory_entry file(source, code);
        return code ? 0 : file_stamp(kBasis, file);
    }
    std::vector<fs::directory_entry> files;
    for (const auto& entry : fs::directory_iterator(source, code))
        files.push_back(entry);
    std::sort(files.begin(), files.end(),
              [](const auto& a, const auto& b) { return a.path() < b.path(); });
    std::uint64_t hash = kBasis;
    for (const auto& file : files)
        hash = file_stamp(hash, file);
    return hash;
}

Article read_article(const fs::path& source) {
    const std::uint64_t stamp = article_stamp(source);
    const auto package = garment::load_package(source);
    return article_of(package->manifest, source, stamp);
}

Article read_article_head(const fs::path& source) {
    if (!fs::is_directory(source)) return read_article(source);
    const std::uint64_t stamp = article_stamp(source);
    const fs::path file = source / "garment.json";
    const std::vector<std::uint8_t> bytes = read_bytes(file, kMostManifest);
    garment::Faults faults;
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const garment::Manifest manifest = garment::read_manifest(text, file.string(), faults);
    if (!faults.empty()) throw garment::PackageError(faults.front());
    return article_of(manifest, source, stamp);
}

Choice next_size(const Choice& choice, const Article& article) {
    Choice out = choice;
    out.size = (choice.size + 1) % (article.sizes.size() + 1);
    return out;
}

Choice next_colour(const Choice& choice, const Article& article) {
    Choice out = choice;
    out.colour = article.colours.empty() ? 0 : (choice.colour + 1) % article.colours.size();
    return out;
}

Choice step(const Choice& choice, int by, std::size_t articles) {
    Choice out;
    const auto count = static_cast<int>(articles);
    if (count == 0) return choice;
    out.article =
        static_cast<std::size_t>(((static_cast<int>(choice.article) + by) % count + count) % count);
    return out;
}

CatalogueWatch::CatalogueWatch(std::vector<Article> known, double every_s)
    : known_(std::move(known)), every_s_(every_s), thread_([this] { run(); }) {}

CatalogueWatch::~CatalogueWatch() {
    stop_ = true;
    thread_.join();
}

void CatalogueWatch::check_all() {
    for (const Article& article : known_) {
        if (stop_) return;
        try {
            (void)read_article(article.source);
        } catch (const std::exception& e) {
            const std::lock_guard lock(mutex_);
            changes_.push_back({article, e.what()});
        }
    }
}

void CatalogueWatch::run() {
    constexpr double kNap_s = 0.02;
    check_all();
    double waited = 0.0;
    while (!stop_) {
        std::this_thread::sleep_for(std::chrono::duration<double>(kNap_s));
        waited += kNap_s;
        if (waited < every_s_) continue;
        waited = 0.0;
        look();
    }
}

void CatalogueWatch::look() {
    for (Article& article : known_) {
        const std::uint64_t now = article_stamp(article.source);
        if (now == article.stamp || stop_) continue;
        CatalogueChange change;
        try {
            change.article = read_article(article.source);
            if (change.article.id != article.id)
                throw Error(article.source.string() + ": its id was " + article.id + ", is now " +
                            change.article.id + "; start the mirror again to take it up");
            article = change.article;
        } catch (const std::exception& e) {
            change.article = article;
            change.refused = e.what();
            article.stamp = now; // said once, until it changes again
        }
        const std::lock_guard lock(mutex_);
        changes_.push_back(std::move(change));
    }
}

std::vector<CatalogueChange> CatalogueWatch::take() {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    return lock.owns_lock() ? std::exchange(changes_, {}) : std::vector<CatalogueChange>{};
}

} // namespace toile::apps::kiosk

// The garments of a mirror: what the carousel shows, and what changed on disk.
#pragma once

#include "garment/package.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace toile::apps::kiosk {

/// One garment as the carousel needs it; its meshes are read when it is put on.
struct Article {
    std::string id;
    std::filesystem::path source; ///< folder or zip
    std::string name;
    std::vector<std::string> sizes;
    std::vector<std::string> colours; ///< names of its colourways, or empty
    std::filesystem::path thumbnail;  ///< or empty
    std::uint64_t stamp = 0;          ///< of the files' names, sizes and times
};

/// What somebody wears or is about to.
struct Choice {
    std::size_t article = 0;
    std::size_t size = 0; ///< 0: the one that suits; else an index into the sizes, plus one
    std::size_t colour = 0;
    bool operator==(const Choice&) const = default;
};

/// A garment that was read again, or refused.
struct CatalogueChange {
    Article article;
    std::string refused; ///< why, in one line; empty: read again
};

/// Folders and zips of garments named by id or path, or all of a folder.
/// \throw Error when there is none, or a named one is missing
[[nodiscard]] std::vector<std::filesystem::path>
garment_sources(const std::vector<std::string>& names, const std::filesystem::path& folder);

/// From garment.json alone, so that a mirror is up at once; a zip is read whole. \throw Error
[[nodiscard]] Article read_article_head(const std::filesystem::path& source);
/// Checks a whole package. \throw Error with the first thing that is wrong
[[nodiscard]] Article read_article(const std::filesystem::path& source);
/// Changes whenever a file of the garment comes, goes, grows or is written.
[[nodiscard]] std::uint64_t article_stamp(const std::filesystem::path& source);

/// The next choice of that article's size or colour; the size comes back to the suiting one.
[[nodiscard]] Choice next_size(const Choice& choice, const Article& article);
[[nodiscard]] Choice next_colour(const Choice& choice, const Article& article);
/// Another article, `by` further, in the suiting size and its first colour.
[[nodiscard]] Choice step(const Choice& choice, int by, std::size_t articles);

/// Looks at the garments from a thread of its own and tells what is or becomes unsound, and what
/// changed.
class CatalogueWatch {
  public:
    CatalogueWatch(std::vector<Article> known, double every_s);
    ~CatalogueWatch();
    CatalogueWatch(const CatalogueWatch&) = delete;
    CatalogueWatch& operator=(const CatalogueWatch&) = delete;

    /// Since the last call. Never waits.
    [[nodiscard]] std::vector<CatalogueChange> take();

  private:
    void run();
    void check_all();
    void look();

    std::vector<Article> known_;
    double every_s_;
    std::mutex mutex_;
    std::vector<CatalogueChange> changes_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

} // namespace toile::apps::kiosk

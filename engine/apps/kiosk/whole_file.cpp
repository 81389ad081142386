#include "apps/kiosk/whole_file.h"

#include "core/bytes.h"
#include "core/error.h"

namespace toile::apps::kiosk {

void write_whole(const std::filesystem::path& file, std::string_view text) {
    std::filesystem::path beside = file;
    beside += ".new";
    std::error_code code;
    // Renaming over a device or a folder would take it away.
    if (std::filesystem::exists(file, code) && !std::filesystem::is_regular_file(file, code))
        throw FileError(file.string(), "is no regular file; name one that may be replaced");
    try {
        write_text(beside, text);
    } catch (const Error&) {
        std::filesystem::remove(beside, code);
        throw;
    }
    std::filesystem::rename(beside, file, code);
    if (!code) return;
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    throw FileError(file.string(), "cannot be replaced: " + code.message());
}

} // namespace toile::apps::kiosk

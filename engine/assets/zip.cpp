#include "assets/zip.h"

#include "core/bytes.h"

#include <algorithm>
#include <memory>
#include <set>
#include <zip.h>

namespace toile::assets {
namespace {

constexpr zip_uint32_t kFileType = 0170000; // of the Unix mode in the upper half of "external"
constexpr zip_uint32_t kRegular = 0100000;
constexpr zip_uint32_t kFolder = 0040000;

struct ArchiveCloser {
    void operator()(zip_t* archive) const { zip_discard(archive); }
};
using Archive = std::unique_ptr<zip_t, ArchiveCloser>;

struct EntryCloser {
    void operator()(zip_file_t* entry) const { zip_fclose(entry); }
};

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return text;
}

class ZipReader {
  public:
    ZipReader(const std::filesystem::path& file, const ZipLimits& limits)
        : file_(file.string()), limits_(limits), bytes_(read_bytes(file, limits.max_file_bytes)) {
        if (bytes_.empty()) throw FileError(file_, "not a good zip: it is empty");
        zip_error_t error;
        zip_error_init(&error);
        zip_source_t* source = zip_source_buffer_create(bytes_.data(), bytes_.size(), 0, &error);
        if (source != nullptr)
            archive_.reset(zip_open_from_source(source, ZIP_RDONLY | ZIP_CHECKCONS, &error));
        const std::string text = zip_error_strerror(&error);
        zip_error_fini(&error);
        if (!archive_) {
            zip_source_free(source);
            throw FileError(file_, "not a good zip: " + text);
        }
    }

    ZipContents run() {
        const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
        if (static_cast<std::size_t>(count) > limits_.max_entries)
            throw FileError(file_, "holds " + std::to_string(count) + " entries, more than the " +
                                       std::to_string(limits_.max_entries) + " allowed");
        for (zip_int64_t i = 0; i < count; ++i)
            read_entry(static_cast<zip_uint64_t>(i));
        check_folders();
        return std::move(contents_);
    }

  private:
    [[nodiscard]] FileError fail(const std::string& entry, const std::string& what) const {
        return {file_, "entry '" + entry + "' " + what};
    }

    void read_entry(zip_uint64_t index) {
        zip_stat_t stat;
        zip_stat_init(&stat);
        if (zip_stat_index(archive_.get(), index, 0, &stat) != 0 ||
            (stat.valid & ZIP_STAT_NAME) == 0)
            throw FileError(file_, "entry #" + std::to_string(index) + " cannot be read");
        std::string name = stat.name;
        const bool folder = !name.empty() && name.back() == '/';
        if (folder) name.pop_back();
        const std::string reason = unsafe_path(name);
        if (!reason.empty()) throw fail(name.substr(0, 200), reason);
        check_kind(index, name, folder);
        if ((stat.valid & ZIP_STAT_ENCRYPTION_METHOD) != 0 && stat.encryption_method != ZIP_EM_NONE)
            throw fail(name, "is encrypted");
        if (stat.comp_method != ZIP_CM_STORE && stat.comp_method != ZIP_CM_DEFLATE)
            throw fail(name, "is packed by method " + std::to_string(stat.comp_method) +
                                 " (only stored and deflate are read)");
        if (folder) {
            folders_.insert(name);
            return;
        }
        if (!names_.insert(lower(name)).second) throw fail(name, "stands twice in the zip");
        contents_[name] = inflate(index, name, stat);
    }

    // Links, devices and the like carry their type in the Unix mode.
    void check_kind(zip_uint64_t index, const std::string& name, bool folder) const {
        zip_uint8_t system = 0;
        zip_uint32_t attributes = 0;
        if (zip_file_get_external_attributes(archive_.get(), index, 0, &system, &attributes) != 0)
            throw fail(name, "has no readable attributes");
        if (system != ZIP_OPSYS_UNIX) return;
        const zip_uint32_t type = (attributes >> 16) & kFileType;
        if (type != 0 && type != (folder ? kFolder : kRegular))
            throw fail(name, "is a link or another special file");
    }

    std::vector<std::uint8_t> inflate(zip_uint64_t index, const std::string& name,
                                      const zip_stat_t& stat) {
        const std::unique_ptr<zip_file_t, EntryCloser> entry(
            zip_fopen_index(archive_.get(), index, 0));
        if (!entry)
            throw fail(name, std::string("cannot be opened: ") + zip_strerror(archive_.get()));
        // What the entry claims is not believed: bytes are counted as they come.
        std::vector<std::uint8_t> data;
        std::vector<std::uint8_t> piece(64u << 10);
        for (;;) {
            const zip_int64_t got = zip_fread(entry.get(), piece.data(), piece.size());
            if (got < 0)
                throw fail(name,
                           std::string("cannot be inflated: ") + zip_file_strerror(entry.get()));
            if (got == 0) break;
            data.insert(data.end(), piece.begin(), piece.begin() + got);
            total_ += static_cast<std::size_t>(got);
            if (data.size() > limits_.max_entry_bytes || total_ > limits_.max_total_bytes)
                throw fail(name, "makes the contents larger than allowed (" +
                                     std::to_string(limits_.max_entry_bytes) + " bytes an entry, " +
                                     std::to_string(limits_.max_total_bytes) + " in all)");
            if (data.size() > (1u << 20) && data.size() / limits_.max_ratio > stat.comp_size)
                throw fail(name, "inflates more than " + std::to_string(limits_.max_ratio) +
                                     " times (a zip bomb?)");
        }
        if (data.size() != stat.size) throw fail(name, "is not as long as the zip claims");
        return data;
    }

    // A file cannot also be the folder of another.
    void check_folders() {
        for (const auto& [name, data] : contents_)
            for (std::size_t at = name.find('/'); at != std::string::npos;
                 at = name.find('/', at + 1))
                folders_.insert(name.substr(0, at));
        for (const std::string& folder : folders_)
            if (names_.contains(lower(folder))) throw fail(folder, "is both a file and a folder");
    }

    std::string file_;
    ZipLimits limits_;
    std::vector<std::uint8_t> bytes_; // lives as long as the archive
    Archive archive_;
    std::size_t total_ = 0;
    std::set<std::string> names_; // lower case
    std::set<std::string> folders_;
    ZipContents contents_;
};

} // namespace

std::string unsafe_path(const std::string& path) {
    if (path.empty()) return "has no name";
    if (path.size() > 255) return "has a path longer than 255 bytes";
    if (path.front() == '/') return "has an absolute path";
    if (path.size() > 1 && path[1] == ':') return "has a drive letter";
    for (const char c : path)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '\\')
            return "has a backslash or control character in its path";
    for (std::size_t begin = 0; begin <= path.size();) {
        const std::size_t end = std::min(path.find('/', begin), path.size());
        const std::string part = path.substr(begin, end - begin);
        if (part == "..") return "leads out of its folder ('..')";
        if (part.empty() || part == ".") return "has an empty part in its path";
        begin = end + 1;
    }
    return "";
}

ZipContents read_zip(const std::filesystem::path& file, const ZipLimits& limits) {
    return ZipReader(file, limits).run();
}

void extract_zip(const std::filesystem::path& file, const std::filesystem::path& folder,
                 const ZipLimits& limits) {
    const ZipContents contents = read_zip(file, limits);
    for (const auto& [name, data] : contents) {
        const std::filesystem::path target = folder / name;
        std::error_code problem;
        std::filesystem::create_directories(target.parent_path(), problem);
        if (problem)
            throw FileError(target.parent_path().string(), "cannot be made: " + problem.message());
        if (std::filesystem::is_symlink(target))
            throw FileError(target.string(), "is a link; it is not written through");
        write_bytes(target, data);
    }
}

void write_zip(const ZipContents& contents, const std::filesystem::path& file) {
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* sink = zip_source_buffer_create(nullptr, 0, 0, &error);
    if (sink == nullptr) throw FileError(file.string(), "out of memory");
    zip_source_keep(sink);
    const std::unique_ptr<zip_source_t, void (*)(zip_source_t*)> owner(sink, zip_source_free);
    Archive archive(zip_open_from_source(sink, ZIP_CREATE | ZIP_TRUNCATE, &error));
    if (!archive) throw FileError(file.string(), "a zip cannot be started");
    const auto check = [&](bool good, const std::string& entry) {
        if (!good)
            throw FileError(file.string(), "entry '" + entry + "' cannot be written: " +
                                               zip_strerror(archive.get()));
    };
    for (const auto& [name, data] : contents) {
        const std::string reason = unsafe_path(name);
        if (!reason.empty()) throw FileError(file.string(), "entry '" + name + "' " + reason);
        zip_source_t* source = zip_source_buffer(archive.get(), data.data(), data.size(), 0);
        check(source != nullptr, name);
        const zip_int64_t index =
            zip_file_add(archive.get(), name.c_str(), source, ZIP_FL_ENC_UTF_8);
        if (index < 0) zip_source_free(source);
        check(index >= 0, name);
        const auto i = static_cast<zip_uint64_t>(index);
        check(zip_file_set_dostime(archive.get(), i, 0, 0x21, 0) == 0, name); // 1980-01-01
        check(zip_set_file_compression(archive.get(), i, ZIP_CM_DEFLATE, 6) == 0, name);
        check(zip_file_set_external_attributes(archive.get(), i, 0, ZIP_OPSYS_UNIX,
                                               (kRegular | 0644u) << 16) == 0,
              name);
    }
    if (zip_close(archive.get()) != 0)
        throw FileError(file.string(),
                        std::string("cannot be written: ") + zip_strerror(archive.get()));
    (void)archive.release();

    // The finished zip stands in the sink.
    if (zip_source_open(sink) != 0) throw FileError(file.string(), "a zip cannot be finished");
    zip_source_seek(sink, 0, SEEK_END);
    const zip_int64_t size = zip_source_tell(sink);
    zip_source_seek(sink, 0, SEEK_SET);
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(std::max<zip_int64_t>(size, 0)));
    const zip_int64_t got = zip_source_read(sink, bytes.data(), bytes.size());
    zip_source_close(sink);
    if (got != size) throw FileError(file.string(), "a zip cannot be finished");
    write_bytes(file, bytes);
}

} // namespace toile::assets

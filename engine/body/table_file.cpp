#include "body/table_file.h"

#include "core/bytes.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace toile::body {
namespace {

// Head: the mark, then the number of tables. A table: length of its name (32 bits), name, kind,
// rows, columns (32 bits each), then its values.
constexpr std::array<char, 8> kMark = {'T', 'o', 'i', 'l', 'e', 'T', 'b', '1'};
constexpr std::uint32_t kIntegers = 1, kNumbers = 2;
constexpr std::size_t kMaxBytes = 64u << 20, kMaxName = 64;
constexpr float kLargest = 32767.0f;

template <class T>
void append(std::vector<std::uint8_t>& bytes, const T* values, std::size_t count) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(values);
    bytes.insert(bytes.end(), first, first + count * sizeof(T));
}

/// Fills `to`, which may be empty.
template <class T>
void copy(std::vector<T>& to, const std::uint8_t* from) {
    if (!to.empty()) std::memcpy(to.data(), from, to.size() * sizeof(T));
}

void append_head(std::vector<std::uint8_t>& bytes, const std::string& name, std::uint32_t kind,
                 std::size_t rows, std::size_t columns) {
    const auto length = static_cast<std::uint32_t>(name.size());
    append(bytes, &length, 1);
    append(bytes, name.data(), name.size());
    const std::array<std::uint32_t, 3> head = {kind, static_cast<std::uint32_t>(rows),
                                               static_cast<std::uint32_t>(columns)};
    append(bytes, head.data(), head.size());
}

/// Names stand in messages of one line.
bool is_name_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// Bytes of a table's values; all that there are (`most`) and one more when it would be more.
std::size_t payload(std::uint32_t kind, std::size_t rows, std::size_t columns, std::size_t most) {
    const std::size_t column = kind == kIntegers ? rows * sizeof(std::uint32_t)
                                                 : sizeof(float) + rows * sizeof(std::int16_t);
    return column != 0 && columns > most / column ? most + 1 : columns * column;
}

} // namespace

void TableWriter::integers(const std::string& name, std::span<const std::uint32_t> values) {
    append_head(bytes_, name, kIntegers, values.size(), 1);
    append(bytes_, values.data(), values.size());
    ++count_;
}

void TableWriter::numbers(const std::string& name, const Eigen::MatrixXf& values) {
    append_head(bytes_, name, kNumbers, static_cast<std::size_t>(values.rows()),
                static_cast<std::size_t>(values.cols()));
    std::vector<std::int16_t> column(static_cast<std::size_t>(values.rows()));
    for (int c = 0; c < values.cols(); ++c) {
        const float largest = values.rows() > 0 ? values.col(c).cwiseAbs().maxCoeff() : 0.0f;
        const float step = largest / kLargest;
        for (int r = 0; r < values.rows(); ++r)
            column[static_cast<std::size_t>(r)] =
                step > 0.0f ? static_cast<std::int16_t>(std::lround(values(r, c) / step))
                            : std::int16_t{0};
        append(bytes_, &step, 1);
        append(bytes_, column.data(), column.size());
    }
    ++count_;
}

void TableWriter::write(const std::filesystem::path& file) const {
    std::vector<std::uint8_t> out;
    append(out, kMark.data(), kMark.size());
    append(out, &count_, 1);
    out.insert(out.end(), bytes_.begin(), bytes_.end());
    write_bytes(file, out);
}

TableReader::TableReader(const std::filesystem::path& file)
    : file_(file.string()), bytes_(read_bytes(file, kMaxBytes)) {
    std::size_t at = 0;
    const auto take = [&](void* to, std::size_t size) {
        if (bytes_.size() - at < size) throw FileError(file_, "is cut off");
        std::memcpy(to, bytes_.data() + at, size);
        at += size;
    };
    std::array<char, kMark.size()> mark{};
    std::uint32_t count = 0;
    if (bytes_.size() < mark.size()) throw FileError(file_, "is no file of tables");
    take(mark.data(), mark.size());
    if (mark != kMark) throw FileError(file_, "is no file of tables");
    take(&count, sizeof count);
    for (std::uint32_t i = 0; i < count; ++i) {
        std::uint32_t length = 0;
        take(&length, sizeof length);
        if (length > kMaxName) throw FileError(file_, "a table's name is too long");
        std::string name(length, '\0');
        take(name.data(), length);
        if (!std::all_of(name.begin(), name.end(), is_name_letter))
            throw FileError(file_, "a table's name is no name");
        std::array<std::uint32_t, 3> head{};
        take(head.data(), sizeof head);
        if (head[0] != kIntegers && head[0] != kNumbers)
            throw FileError(file_, "table '" + name + "' is of an unknown kind");
        const Table table = {head[0], head[1], head[2], at};
        const std::size_t left = bytes_.size() - at;
        const std::size_t size = payload(table.kind, table.rows, table.columns, left);
        if (size > left) throw FileError(file_, "is cut off in '" + name + "'");
        at += size;
        if (!tables_.emplace(name, table).second)
            throw FileError(file_, "table '" + name + "' stands twice");
    }
    if (at != bytes_.size()) throw FileError(file_, "goes on after its last table");
}

const TableReader::Table& TableReader::find(const std::string& name, std::uint32_t kind) const {
    const auto found = tables_.find(name);
    if (found == tables_.end()) throw FileError(file_, "has no table '" + name + "'");
    if (found->second.kind != kind)
        throw FileError(file_, "table '" + name + "' is of the wrong kind");
    return found->second;
}

std::vector<std::uint32_t> TableReader::integers(const std::string& name,
                                                 std::uint32_t bound) const {
    const Table& table = find(name, kIntegers);
    std::vector<std::uint32_t> out(table.rows * table.columns);
    copy(out, bytes_.data() + table.offset);
    for (const auto value : out)
        if (value >= bound)
            throw FileError(file_,
                            "table '" + name + "': " + std::to_string(value) + " is out of range");
    return out;
}

Eigen::MatrixXf TableReader::numbers(const std::string& name, std::size_t rows,
                                     std::size_t columns) const {
    const Table& table = find(name, kNumbers);
    if (table.rows != rows || table.columns != columns)
        throw FileError(file_, "table '" + name + "' has " + std::to_string(table.rows) + " x " +
                                   std::to_string(table.columns) + " values instead of " +
                                   std::to_string(rows) + " x " + std::to_string(columns));
    Eigen::MatrixXf out(static_cast<int>(rows), static_cast<int>(columns));
    std::vector<std::int16_t> column(rows);
    const std::uint8_t* at = bytes_.data() + table.offset;
    for (int c = 0; c < out.cols(); ++c) {
        float step = 0.0f;
        std::memcpy(&step, at, sizeof step);
        if (!std::isfinite((kLargest + 1.0f) * step))
            throw FileError(file_, "table '" + name + "' is not finite");
        copy(column, at + sizeof step);
        at += sizeof step + rows * sizeof(std::int16_t);
        for (int r = 0; r < out.rows(); ++r)
            out(r, c) = step * static_cast<float>(column[static_cast<std::size_t>(r)]);
    }
    return out;
}

} // namespace toile::body

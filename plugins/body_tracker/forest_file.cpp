#include "body_tracker/forest.h"
#include "core/bytes.h"
#include "core/digest.h"

#include <array>
#include <cstring>
#include <string>

namespace toile::body_tracker {
namespace {

constexpr std::array<char, 8> kMark = {'T', 'o', 'i', 'l', 'e', 'F', 'o', '1'};
constexpr std::size_t kMaxBytes = 64u << 20;
static_assert(sizeof(ForestNode) == 16);

std::uint64_t checksum(std::span<const std::uint8_t> bytes) {
    Digest digest;
    digest.add(bytes);
    return digest.value();
}

template <class T>
void append(std::vector<std::uint8_t>& bytes, const T* values, std::size_t count) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(values);
    bytes.insert(bytes.end(), first, first + count * sizeof(T));
}

class Reader {
  public:
    Reader(std::span<const std::uint8_t> bytes, const std::string& name)
        : rest_(bytes), name_(name) {}

    template <class T>
    std::vector<T> take(std::size_t count) {
        if (count > rest_.size() / sizeof(T)) fail("ends too early");
        std::vector<T> out(count);
        if (count > 0) std::memcpy(out.data(), rest_.data(), count * sizeof(T));
        rest_ = rest_.subspan(count * sizeof(T));
        return out;
    }
    [[nodiscard]] bool empty() const { return rest_.empty(); }
    [[noreturn]] void fail(const std::string& what) const {
        throw FileError(name_, what + "; take it anew or train it again");
    }

  private:
    std::span<const std::uint8_t> rest_;
    const std::string& name_;
};

/// Every walk from the root must end in a leaf.
void check_nodes(const ForestTree& tree, std::size_t leaves, bool allow_growing,
                 const Reader& reader) {
    for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
        const std::int32_t child = tree.nodes[n].child;
        const auto place = "node " + std::to_string(n);
        if (child == 0 && !allow_growing) reader.fail(place + " leads nowhere");
        if (child < 0 && static_cast<std::size_t>(~child) >= leaves)
            reader.fail(place + " names a leaf that is not there");
        const auto target = static_cast<std::size_t>(child);
        if (child > 0 && (target <= n || target + 1 >= tree.nodes.size()))
            reader.fail(place + " names a node that is not behind it");
    }
}

ForestTree take_tree(Reader& reader, std::size_t classes, bool allow_growing) {
    const auto sizes = reader.take<std::uint32_t>(2);
    if (sizes[0] == 0) reader.fail("a tree has no nodes");
    ForestTree tree;
    tree.nodes = reader.take<ForestNode>(sizes[0]);
    tree.leaves = reader.take<std::uint8_t>(sizes[1] * classes);
    check_nodes(tree, sizes[1], allow_growing, reader);
    return tree;
}

} // namespace

std::vector<std::uint8_t> encode_forest(const Forest& forest) {
    std::vector<std::uint8_t> out;
    append(out, kMark.data(), kMark.size());
    const std::array<std::uint32_t, 2> head = {static_cast<std::uint32_t>(forest.class_count),
                                               static_cast<std::uint32_t>(forest.trees.size())};
    append(out, head.data(), head.size());
    for (const ForestTree& tree : forest.trees) {
        const std::array<std::uint32_t, 2> sizes = {
            static_cast<std::uint32_t>(tree.nodes.size()),
            static_cast<std::uint32_t>(tree.leaves.size() /
                                       static_cast<std::size_t>(forest.class_count))};
        append(out, sizes.data(), sizes.size());
        append(out, tree.nodes.data(), tree.nodes.size());
        append(out, tree.leaves.data(), tree.leaves.size());
    }
    auto push_back = forest.push_back_mm;
    push_back.resize(static_cast<std::size_t>(forest.class_count));
    append(out, push_back.data(), push_back.size());
    const std::uint64_t sum = checksum(out);
    append(out, &sum, 1);
    return out;
}

Forest decode_forest(std::span<const std::uint8_t> bytes, const std::string& name,
                     bool allow_growing) {
    constexpr std::size_t kSum = sizeof(std::uint64_t);
    if (bytes.size() < kMark.size() + kSum ||
        std::memcmp(bytes.data(), kMark.data(), kMark.size()) != 0)
        throw FileError(name, "is not a forest of body parts (it does not begin with ToileFo1)");
    const auto body = bytes.first(bytes.size() - kSum);
    std::uint64_t sum = 0;
    std::memcpy(&sum, bytes.data() + body.size(), kSum);
    Reader reader(body.subspan(kMark.size()), name);
    if (sum != checksum(body)) reader.fail("is damaged (its checksum differs)");
    const auto head = reader.take<std::uint32_t>(2);
    if (head[0] < 1 || head[0] > kMaxClasses) reader.fail("has no classes or more than 32");
    if (head[1] < 1 || head[1] > kMaxTrees) reader.fail("has no trees or more than 16");
    Forest forest;
    forest.class_count = static_cast<int>(head[0]);
    for (std::uint32_t t = 0; t < head[1]; ++t)
        forest.trees.push_back(take_tree(reader, head[0], allow_growing));
    forest.push_back_mm = reader.take<std::int16_t>(head[0]);
    if (!reader.empty()) reader.fail("has bytes behind its end");
    return forest;
}

void save_forest(const Forest& forest, const std::filesystem::path& file) {
    write_bytes(file, encode_forest(forest));
}

Forest load_forest(const std::filesystem::path& file) {
    return decode_forest(read_bytes(file, kMaxBytes), file.string());
}

} // namespace toile::body_tracker

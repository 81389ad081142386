#include "garment/manifest_reader.h"

#include <algorithm>
#include <cctype>
#include <sstream>

namespace toile::garment {
namespace {

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
bool is_letter(char c) {
    return c >= 'a' && c <= 'z';
}

} // namespace

bool is_identifier(std::string_view text) {
    if (text.empty() || text.size() > 64 || !is_letter(text.front())) return false;
    return std::all_of(text.begin(), text.end(),
                       [](char c) { return is_letter(c) || is_digit(c) || c == '-' || c == '_'; });
}

bool is_version(std::string_view text) {
    const std::string_view numbers = text.substr(0, text.find_first_of("-+"));
    std::size_t digits = 0;
    std::size_t dots = 0;
    for (const char c : numbers) {
        if (c == '.') {
            if (digits == 0) return false;
            digits = 0;
            ++dots;
        } else if (!is_digit(c) || ++digits > 6) {
            return false;
        }
    }
    return dots == 2 && digits > 0 && text.size() <= 64;
}

std::string unsafe_path_reason(const std::string& path) {
    if (path.empty()) return "is empty";
    if (path.size() > 200) return "is longer than 200 bytes";
    const bool strange = std::any_of(path.begin(), path.end(), [](char c) {
        return static_cast<unsigned char>(c) < 32 || c == '\\' || c == ':';
    });
    if (strange) return "holds a control letter, a backslash or a colon";
    if (path.front() == '/') return "is absolute; paths are relative to garment.json";
    std::istringstream in(path);
    for (std::string part; std::getline(in, part, '/');)
        if (part == ".." || part == "." || part.empty())
            return "holds '" + part + "/'; files must stand inside the package";
    return "";
}

} // namespace toile::garment

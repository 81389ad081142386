#include "docs/link_rules.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <regex>
#include <set>

namespace toile::test {
namespace {

namespace fs = std::filesystem;

const std::set<std::string> kSkippedFolders = {"build", "out", "node_modules"};
const std::set<std::string> kSources = {".h",  ".cpp", ".c",    ".cmake",
                                        ".py", ".mjs", ".json", ".md"};

std::vector<std::string> lines_of(const fs::path& file) {
    std::vector<std::string> out;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);)
        out.push_back(line);
    return out;
}

bool is_text(const fs::path& file) {
    return kSources.contains(file.extension().string()) || file.extension().empty() ||
           file.filename() == "CMakeLists.txt";
}

std::vector<fs::path> files_below(const fs::path& root) {
    std::vector<fs::path> out;
    for (auto it = fs::recursive_directory_iterator(root); it != fs::recursive_directory_iterator();
         ++it) {
        const std::string name = it->path().filename().string();
        if (it->is_directory() && (kSkippedFolders.contains(name) || name[0] == '.'))
            it.disable_recursion_pending();
        else if (it->is_regular_file() && is_text(it->path()))
            out.push_back(it->path());
    }
    std::sort(out.begin(), out.end());
    return out;
}

/// Lines that are no code: fenced blocks are emptied, code spans cut out.
std::vector<std::string> prose_of(std::vector<std::string> lines) {
    static const std::regex kCodeSpan("`[^`]*`");
    bool fenced = false;
    for (std::string& line : lines) {
        const bool fence = line.starts_with("```");
        if (fence || fenced) line.clear();
        fenced = fenced != fence;
        line = std::regex_replace(line, kCodeSpan, "");
    }
    return lines;
}

/// A heading as the part of a link after '#': lower case, blanks as '-', other signs dropped.
std::string anchor_of(const std::string& heading) {
    std::string out;
    for (const char c : heading) {
        const auto u = static_cast<unsigned char>(c);
        if (std::isalnum(u) != 0 || c == '-' || c == '_' || u >= 0x80)
            out += static_cast<char>(std::tolower(u));
        else if (c == ' ')
            out += '-';
    }
    return out;
}

bool has_heading(const fs::path& page, const std::string& anchor) {
    const auto lines = lines_of(page);
    return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
        const std::size_t text = line.find_first_not_of('#');
        return text != 0 && text != std::string::npos && line[text] == ' ' &&
               anchor_of(line.substr(text + 1)) == anchor;
    });
}

/// Empty when a link of `page` leads somewhere.
std::string fault_of(const std::string& link, const fs::path& page) {
    static const std::regex kElsewhere("[a-z]+:.*");
    if (std::regex_match(link, kElsewhere)) return {};
    const std::size_t hash = link.find('#');
    const std::string path = link.substr(0, hash);
    const fs::path target = path.empty() ? page : page.parent_path() / path;
    if (!fs::exists(target)) return "links to " + path + ", which is not there";
    if (hash != std::string::npos && !has_heading(target, link.substr(hash + 1)))
        return "links to " + link + ", but that page has no such heading";
    return {};
}

} // namespace

std::vector<std::string> broken_links(const fs::path& root) {
    static const std::regex kLink(R"(\]\(([^)\s]+)\))");
    static const std::regex kMention(R"(\bdocs/[A-Za-z0-9_/.-]+\.(md|json|png))");
    std::vector<std::string> out;
    for (const fs::path& file : files_below(root)) {
        const auto lines = lines_of(file);
        const auto report = [&](std::size_t line, const std::string& what) {
            if (!what.empty())
                out.push_back(fs::relative(file, root).string() + ":" + std::to_string(line + 1) +
                              ": " + what);
        };
        const auto each_match = [](const std::string& line, const std::regex& pattern,
                                   const auto& use) {
            for (std::sregex_iterator it(line.begin(), line.end(), pattern), end; it != end; ++it)
                use(*it);
        };
        for (std::size_t i = 0; i < lines.size(); ++i)
            each_match(lines[i], kMention, [&](const std::smatch& match) {
                if (!fs::exists(root / match.str()))
                    report(i, "names " + match.str() + ", which is not there");
            });
        if (file.extension() != ".md") continue;
        const auto prose = prose_of(lines);
        for (std::size_t i = 0; i < prose.size(); ++i)
            each_match(prose[i], kLink, [&](const std::smatch& match) {
                report(i, fault_of(match[1].str(), file));
            });
    }
    std::sort(out.begin(), out.end());
    return out;
}

} // namespace toile::test

#include "shape.hpp"

#include <algorithm>
#include <charconv>
#include <vector>

namespace contactbench::runtime {

namespace {

using Kind = Shape::Kind;

// As %g has it, but whatever the process's locale: a comma would end the number.
std::string shown(double x) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, x, std::chars_format::general, 6).ptr};
}

std::string whole(double x) { return std::to_string(std::int64_t(x)); }

std::string below(const std::string& path, std::string_view name) {
    return path.empty() ? std::string(name) : path + "." + std::string(name);
}

void check_members(const Json& value, const std::string& path, const std::vector<Member>& members) {
    if (value.type != Json::Type::object) fail(CB_ERROR_SCHEMA, path.empty() ? "the file" : path, "not an object");
    for (const Member& member : members)
        if (!member.optional && !value.find(member.name)) fail(CB_ERROR_SCHEMA, below(path, member.name), "missing");
    for (const auto& found : value.members)
        if (std::none_of(members.begin(), members.end(), [&](const Member& m) { return m.name == found.name; }))
            fail(CB_ERROR_SCHEMA, below(path, found.name.substr(0, 100)), "unknown");
}

bool alphanumeric(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

bool all_hexadecimal(std::string_view text) {
    return text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool is_time(std::string_view text) {
    constexpr std::string_view shape = "0000-00-00T00:00:00Z";
    if (text.size() != shape.size()) return false;
    for (std::size_t i = 0; i < shape.size(); ++i)
        if (shape[i] == '0' ? text[i] < '0' || text[i] > '9' : text[i] != shape[i]) return false;
    return true;
}

// In the folder, never a way out of it.
bool is_file_name(std::string_view text) {
    return !text.empty() && text.size() <= 100 && alphanumeric(text[0]) &&
           std::all_of(text.begin(), text.end(),
                       [](char c) { return alphanumeric(c) || c == '.' || c == '_' || c == '-'; });
}

// Null, or what is wrong.
const char* fault(std::string_view text, Format format) {
    switch (format) {
        case Format::hash: return text.size() == 64 && all_hexadecimal(text) ? nullptr : "not a SHA-256";
        case Format::file: return is_file_name(text) ? nullptr : "not the name of a file in the bundle";
        case Format::time: return is_time(text) ? nullptr : "not like 2026-01-02T03:04:05Z";
        case Format::colour: break;
    }
    return text.size() == 7 && text[0] == '#' && all_hexadecimal(text.substr(1)) ? nullptr : "not like #1f77b4";
}

void check_number(const Json& value, const Shape& s, const std::string& path) {
    const bool is_whole = value.type == Json::Type::integer, counted = s.kind == Kind::integer;
    if (!is_whole && (counted || value.type != Json::Type::number))
        fail(CB_ERROR_SCHEMA, path, counted ? "not a whole number" : "not a number");
    const double x = value.number;
    if (x < s.least || x > s.most || (s.above && x == s.least) || (s.below && x == s.most)) {
        const std::string told = counted ? std::to_string(value.integer) : shown(x);
        const auto end = counted ? whole : shown;
        fail(CB_ERROR_VALUE, path, told + " is outside " + end(s.least) + " to " + end(s.most));
    }
}

void check_word(const std::string& text, std::string_view words, const std::string& path) {
    std::string listed;
    bool known = false;
    for (std::size_t at = 0, end = 0; at <= words.size(); at = end + 1) {
        end = std::min(words.find('|', at), words.size());
        const std::string word(words.substr(at, end - at));
        known |= text == word;
        listed += (at > 0 ? " or '" : "'") + word + "'";
    }
    if (!known) fail(CB_ERROR_SCHEMA, path, "not " + listed);
}

void check_text(const Json& value, const Shape& s, const std::string& path) {
    if (value.type != Json::Type::text) fail(CB_ERROR_SCHEMA, path, "not a text");
    if (s.kind == Kind::one_of) return check_word(value.text, s.words, path);
    if (s.kind == Kind::formatted) {
        if (const char* what = fault(value.text, s.format)) fail(CB_ERROR_VALUE, path, what);
        return;
    }
    // Characters, not bytes: those that continue one do not count.
    const auto count = std::count_if(value.text.begin(), value.text.end(), [](char c) { return (c & 0xC0) != 0x80; });
    if (double(count) > s.most) fail(CB_ERROR_VALUE, path, "the text is too long");
}

void check_array(const Json& value, const Shape& s, const std::string& path) {
    if (value.type != Json::Type::array) fail(CB_ERROR_SCHEMA, path, "not an array");
    const double count = double(value.items.size());
    if (count < s.least || count > s.most)
        fail(CB_ERROR_SCHEMA, path,
             whole(count) + " entries" +
                 (s.least == s.most ? " instead of " + whole(s.most) : " are too few or too many"));
    for (std::size_t i = 0; i < value.items.size(); ++i)
        check(value.items[i], *s.item, path + "[" + std::to_string(i) + "]");
}

// Names of files, each with its hash.
void check_files(const Json& value, const Shape& s, const std::string& path) {
    const double count = double(value.members.size());
    if (value.type != Json::Type::object || count < s.least || count > s.most)
        fail(CB_ERROR_SCHEMA, path, "not an object of " + whole(s.least) + " to " + whole(s.most) + " files");
    for (const auto& [name, hash] : value.members) {
        if (!is_file_name(name)) fail(CB_ERROR_VALUE, path, "holds a name that is no file of a bundle");
        if (hash.type != Json::Type::text || fault(hash.text, Format::hash))
            fail(CB_ERROR_VALUE, path + "." + name, "not a SHA-256");
    }
}

}  // namespace

void fail(int code, const std::string& field, const std::string& what) {
    throw LoadError(code, "contactbench.json: " + field + ": " + what + "; export the bundle again");
}

void check_names(const Json& value, const std::string& path, std::initializer_list<std::string_view> names) {
    std::vector<Member> members;
    for (const std::string_view name : names) members.push_back({name, flag});
    check_members(value, path, members);
}

void check(const Json& value, const Shape& s, const std::string& path) {
    if (s.null && value.type == Json::Type::null) return;
    switch (s.kind) {
        case Kind::flag:
            if (value.type != Json::Type::boolean) fail(CB_ERROR_SCHEMA, path, "neither true nor false");
            return;
        case Kind::integer:
        case Kind::number: return check_number(value, s, path);
        case Kind::one_of:
        case Kind::formatted:
        case Kind::text: return check_text(value, s, path);
        case Kind::array: return check_array(value, s, path);
        case Kind::files: return check_files(value, s, path);
        case Kind::object: break;
    }
    check_members(value, path, {s.members, s.members + s.count});
    for (const Member* member = s.members; member != s.members + s.count; ++member)
        if (const Json* found = value.find(member->name)) check(*found, member->shape, below(path, member->name));
}

}  // namespace contactbench::runtime

#include "fields.hpp"

#include <algorithm>
#include <cstdio>

namespace contactbench::runtime {

namespace {

std::string shown(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", x);
    return text;
}

bool alphanumeric(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

}  // namespace

void fail(int code, const std::string& field, const std::string& what) {
    throw LoadError(code, "contactbench.json: " + field + ": " + what + "; export the bundle again");
}

double to_number(const Json& value, const std::string& field, Range range) {
    if (value.type != Json::Type::number && value.type != Json::Type::integer)
        fail(CB_ERROR_SCHEMA, field, "not a number");
    const double x = value.number;
    if (x < range.lo || x > range.hi || (range.above && x == range.lo))
        fail(CB_ERROR_VALUE, field, shown(x) + " is outside " + shown(range.lo) + " to " + shown(range.hi));
    return x;
}

std::string to_text(const Json& value, const std::string& field, std::size_t longest) {
    if (value.type != Json::Type::text) fail(CB_ERROR_SCHEMA, field, "not a text");
    // Characters, not bytes: those that continue one do not count.
    const auto count = std::count_if(value.text.begin(), value.text.end(), [](char c) { return (c & 0xC0) != 0x80; });
    if (std::size_t(count) > longest) fail(CB_ERROR_VALUE, field, "the text is too long");
    return value.text;
}

bool is_hash(std::string_view text) {
    return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool is_file_name(std::string_view text) {
    return !text.empty() && text.size() <= 100 && alphanumeric(text[0]) &&
           std::all_of(text.begin(), text.end(),
                       [](char c) { return alphanumeric(c) || c == '.' || c == '_' || c == '-'; });
}

Fields::Fields(const Json& value, std::string path, std::initializer_list<std::string_view> names)
    : object_(value), path_(std::move(path)) {
    const std::string shown_path = path_.empty() ? "the file" : path_;
    if (value.type != Json::Type::object) fail(CB_ERROR_SCHEMA, shown_path, "not an object");
    for (const std::string_view name : names)
        if (!value.find(name)) fail(CB_ERROR_SCHEMA, this->path(name), "missing");
    for (const auto& member : value.members)
        if (std::find(names.begin(), names.end(), member.first) == names.end())
            fail(CB_ERROR_SCHEMA, this->path(member.first.substr(0, 100)), "unknown");
}

std::string Fields::path(std::string_view name) const {
    return path_.empty() ? std::string(name) : path_ + "." + std::string(name);
}

const Json& Fields::at(std::string_view name) const {
    const Json* value = object_.find(name);
    if (!value) fail(CB_ERROR_SCHEMA, path(name), "missing");
    return *value;
}

const Json& Fields::typed(std::string_view name, Json::Type type, const char* what) const {
    const Json& value = at(name);
    if (value.type != type) fail(CB_ERROR_SCHEMA, path(name), what);
    return value;
}

double Fields::number(std::string_view name, Range range) const { return to_number(at(name), path(name), range); }

std::int64_t Fields::integer(std::string_view name, std::int64_t lo, std::int64_t hi) const {
    const std::int64_t i = typed(name, Json::Type::integer, "not a whole number").integer;
    if (i < lo || i > hi)
        fail(CB_ERROR_VALUE, path(name),
             std::to_string(i) + " is outside " + std::to_string(lo) + " to " + std::to_string(hi));
    return i;
}

bool Fields::flag(std::string_view name) const {
    return typed(name, Json::Type::boolean, "neither true nor false").boolean;
}

std::string Fields::text(std::string_view name, std::size_t longest) const {
    return to_text(at(name), path(name), longest);
}

void Fields::literal(std::string_view name, std::string_view value) const {
    if (text(name) != value) fail(CB_ERROR_SCHEMA, path(name), "not '" + std::string(value) + "'");
}

std::string Fields::hash(std::string_view name) const {
    std::string value = text(name);
    if (!is_hash(value)) fail(CB_ERROR_VALUE, path(name), "not a SHA-256");
    return value;
}

std::string Fields::file(std::string_view name) const {
    std::string value = text(name);
    if (!is_file_name(value)) fail(CB_ERROR_VALUE, path(name), "not the name of a file in the bundle");
    return value;
}

std::vector<double> Fields::row(const Json& value, const std::string& field, std::size_t count, Range range) const {
    if (value.type != Json::Type::array) fail(CB_ERROR_SCHEMA, field, "not an array");
    if (value.items.size() != count)
        fail(CB_ERROR_SCHEMA, field,
             std::to_string(value.items.size()) + " entries instead of " + std::to_string(count));
    std::vector<double> out;
    for (std::size_t i = 0; i < count; ++i)
        out.push_back(to_number(value.items[i], field + "[" + std::to_string(i) + "]", range));
    return out;
}

std::vector<double> Fields::numbers(std::string_view name, std::size_t count, Range range) const {
    return row(at(name), path(name), count, range);
}

std::vector<double> Fields::matrix(std::string_view name, std::size_t rows, std::size_t columns) const {
    std::vector<double> out;
    const std::vector<Json>& items = array(name, rows, rows);
    for (std::size_t i = 0; i < rows; ++i) {
        const auto values = row(items[i], path(name) + "[" + std::to_string(i) + "]", columns, any);
        out.insert(out.end(), values.begin(), values.end());
    }
    return out;
}

std::vector<double> Fields::limits(std::string_view name, std::size_t count, double none) const {
    std::vector<double> out;
    for (const Json& item : array(name, count, count))
        out.push_back(item.type == Json::Type::null
                          ? none
                          : to_number(item, path(name) + "[" + std::to_string(out.size()) + "]", positive));
    return out;
}

const std::vector<Json>& Fields::array(std::string_view name, std::size_t least, std::size_t most) const {
    const auto& items = typed(name, Json::Type::array, "not an array").items;
    if (items.size() < least || items.size() > most)
        fail(CB_ERROR_SCHEMA, path(name), std::to_string(items.size()) + " entries are too few or too many");
    return items;
}

}  // namespace contactbench::runtime

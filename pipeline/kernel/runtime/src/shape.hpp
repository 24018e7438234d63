// What a JSON value has to be; whatever is missing, unknown, of the wrong type or out of range is an error that names it.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "json.hpp"

namespace contactbench::runtime {

struct Member;

// How a text is written.
enum class Format { hash, file, time, colour };

struct Shape {
    enum class Kind { flag, integer, number, one_of, formatted, text, array, object, files };
    Kind kind;
    double least = 0.0, most = 0.0;    // of a number; of the count of entries, of the characters of a text
    bool above = false, below = false;  // the ends themselves are out
    bool null = false;                  // or null
    Format format = Format::hash;
    std::string_view words{};           // one|another
    const Member* members = nullptr;    // these and no others, in any order
    std::size_t count = 0;
    const Shape* item = nullptr;        // each entry
};

struct Member {
    std::string_view name;
    Shape shape;
    bool optional = false;
};

constexpr Shape number(double least, double most, bool above = false, bool below = false) {
    return {Shape::Kind::number, least, most, above, below};
}
constexpr Shape integer(double least, double most) { return {Shape::Kind::integer, least, most}; }
constexpr Shape text(double most) { return {Shape::Kind::text, 0.0, most}; }
constexpr Shape files(double least, double most) { return {Shape::Kind::files, least, most}; }
constexpr Shape one_of(std::string_view words) {
    Shape s{Shape::Kind::one_of};
    s.words = words;
    return s;
}
constexpr Shape formatted(Format format) {
    Shape s{Shape::Kind::formatted};
    s.format = format;
    return s;
}
constexpr Shape array(const Shape& item, double least, double most) {
    Shape s{Shape::Kind::array, least, most};
    s.item = &item;
    return s;
}
template <std::size_t N>
constexpr Shape object(const Member (&members)[N]) {
    Shape s{Shape::Kind::object};
    s.members = members, s.count = N;
    return s;
}
constexpr Shape or_null(Shape s) {
    s.null = true;
    return s;
}
inline constexpr Shape any = number(-1e9, 1e9), positive = number(0.0, 1e9, true), not_negative = number(0.0, 1e9);
inline constexpr Shape flag{Shape::Kind::flag};

// Throws LoadError; `path` is where it stands in contactbench.json, empty for the whole.
void check(const Json& value, const Shape& shape, const std::string& path);
// An object of exactly these members.
void check_names(const Json& value, const std::string& path, std::initializer_list<std::string_view> names);
[[noreturn]] void fail(int code, const std::string& field, const std::string& what);

}  // namespace contactbench::runtime

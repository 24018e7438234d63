// Strict JSON (RFC 8259): UTF-8, no duplicate keys, bounded depth, numbers that a double holds.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "errors.hpp"

namespace contactbench::runtime {

struct JsonMember;

struct Json {
    enum class Type { null, boolean, integer, number, text, array, object };
    Type type = Type::null;
    bool boolean = false;
    std::int64_t integer = 0;
    double number = 0.0;  // also of an integer
    std::string text;     // UTF-8
    std::vector<Json> items;
    std::vector<JsonMember> members;

    const Json* find(std::string_view key) const;
    // Of an object that was checked: the member is there.
    const Json& operator[](std::string_view key) const { return *find(key); }
};

struct JsonMember {
    std::string name;
    Json value;
};

// Throws LoadError (CB_ERROR_JSON) that tells the byte.
Json parse_json(std::string_view text);

// The one spelling, as contactbench writes a bundle's JSON: keys in the order of their bytes, no spaces, a line feed.
std::string encode_json(const Json& value);
// The shortest digits that read back as the same double, as Python's repr has them.
std::string repr(double x);
// Of the first byte in which two texts differ.
std::size_t first_difference(std::string_view one, std::string_view other);

}  // namespace contactbench::runtime

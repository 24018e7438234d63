// Strict JSON (RFC 8259): UTF-8, no duplicate keys, bounded depth, numbers that a double holds.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "errors.hpp"

namespace contactbench::runtime {

struct Json {
    enum class Type { null, boolean, integer, number, text, array, object };
    Type type = Type::null;
    bool boolean = false;
    std::int64_t integer = 0;
    double number = 0.0;  // also of an integer
    std::string text;     // UTF-8
    std::vector<Json> items;
    std::vector<std::pair<std::string, Json>> members;

    const Json* find(std::string_view key) const {
        for (const auto& [name, value] : members)
            if (name == key) return &value;
        return nullptr;
    }
};

// Throws LoadError (CB_ERROR_JSON) that tells the byte.
Json parse_json(std::string_view text);

}  // namespace contactbench::runtime

// Reading a JSON object field by field; whatever is missing, unknown or of the wrong type is an error that
// names it.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "json.hpp"

namespace contactbench::runtime {

// Of a number, both ends included unless `above`.
struct Range {
    double lo = -1e9, hi = 1e9;
    bool above = false;  // lo itself is out
};
inline constexpr Range any{}, positive{0.0, 1e9, true}, not_negative{0.0, 1e9, false};

[[noreturn]] void fail(int code, const std::string& field, const std::string& what);

class Fields {
public:
    // Exactly these fields, in any order.
    Fields(const Json& value, std::string path, std::initializer_list<std::string_view> names);

    const Json& at(std::string_view name) const;
    bool is_null(std::string_view name) const { return at(name).type == Json::Type::null; }
    std::string path(std::string_view name) const;

    double number(std::string_view name, Range range = any) const;
    std::int64_t integer(std::string_view name, std::int64_t lo, std::int64_t hi) const;
    bool flag(std::string_view name) const;
    std::string text(std::string_view name, std::size_t longest = 1000) const;
    void literal(std::string_view name, std::string_view value) const;
    std::string hash(std::string_view name) const;
    std::string file(std::string_view name) const;
    // Arrays of fixed length; a matrix comes row by row.
    std::vector<double> numbers(std::string_view name, std::size_t count, Range range = any) const;
    std::vector<double> matrix(std::string_view name, std::size_t rows, std::size_t columns) const;
    // Each a number or null.
    std::vector<double> limits(std::string_view name, std::size_t count, double none) const;
    const std::vector<Json>& array(std::string_view name, std::size_t least, std::size_t most) const;

private:
    const Json& typed(std::string_view name, Json::Type type, const char* what) const;
    std::vector<double> row(const Json& value, const std::string& field, std::size_t count, Range range) const;

    const Json& object_;
    std::string path_;
};

double to_number(const Json& value, const std::string& field, Range range);
std::string to_text(const Json& value, const std::string& field, std::size_t longest);
bool is_hash(std::string_view text);
bool is_file_name(std::string_view text);  // in the folder, never a way out of it

}  // namespace contactbench::runtime

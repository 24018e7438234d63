// Blocks of tables in text.
#include <nanobind/stl/vector.h>

#include <cstring>

#include "bindings.hpp"
#include "contactbench/table.hpp"
#include "parts.hpp"

namespace contactbench::bindings {

namespace {

constexpr std::size_t least_bytes = 1 << 18;  // that are worth a thread

nb::object texts_of(const char* data, const std::vector<PlainRows>& parts, std::size_t count, std::size_t width) {
    std::vector<std::uint8_t> texts(count * width);
    std::uint8_t* to = texts.data();
    for (const PlainRows& part : parts)
        for (const Span& span : part.texts) {
            std::memcpy(to, data + span.first, span.last - span.first);
            to += width;
        }
    return make_array(std::move(texts), {count, width});
}

nb::object plain_rows(nb::bytes block, std::size_t cells, std::vector<std::size_t> columns, std::vector<bool> required,
                      std::int64_t text, std::size_t longest_text) {
    const char* data = block.c_str();
    const std::size_t size = block.size();
    if (size == 0 || data[size - 1] != '\n') throw nb::value_error("block: the last byte must be a line feed");
    if (columns.size() != required.size()) throw nb::value_error("columns and required differ in number");
    if (columns.empty()) throw nb::value_error("columns: there are none");
    for (std::size_t column : columns)
        if (column >= cells) throw nb::index_error("column out of range");
    if (text >= 0 && std::size_t(text) >= cells) throw nb::index_error("text column out of range");
    const std::size_t width = columns.size();
    const Layout layout{cells, std::move(columns), {required.begin(), required.end()}, text < 0 ? Layout::none : std::size_t(text)};
    std::vector<PlainRows> parts(parts_of(size, least_bytes));
    std::vector<std::uint8_t> plain(parts.size());
    std::vector<double> numbers;
    std::vector<std::int64_t> unsure, where;
    std::size_t count = 0, longest = 1;
    {
        const nb::gil_scoped_release release;
        const auto line = [&](std::size_t at) {  // where the first line begins that does so at `at` or behind it
            return at == 0 ? 0 : std::size_t(static_cast<const char*>(std::memchr(data + at - 1, '\n', size - at + 1)) - data) + 1;
        };
        in_parts(size, least_bytes, [&](std::size_t from, std::size_t to, std::size_t part) {
            plain[part] = read_plain(data, line(from), line(to), layout, parts[part]);
        });
        for (std::uint8_t each : plain)
            if (!each) count = Layout::none;
        for (std::size_t p = 0; count != Layout::none && p < parts.size(); ++p) {
            const PlainRows& part = parts[p];
            for (std::size_t place : part.unsure) unsure.push_back(std::int64_t(place + numbers.size()));
            for (const Span& span : part.where) where.insert(where.end(), {std::int64_t(span.first), std::int64_t(span.last)});
            for (const Span& span : part.texts) longest = std::max(longest, span.last - span.first);
            numbers.insert(numbers.end(), part.numbers.begin(), part.numbers.end());
            count += part.count;
        }
    }
    if (count == Layout::none || longest > longest_text) return nb::none();
    const std::size_t left = unsure.size();
    const nb::object texts = text < 0 ? nb::none() : texts_of(data, parts, count, longest);
    return nb::make_tuple(make_array(std::move(numbers), {count, width}), make_array(std::move(unsure), {left}),
                          make_array(std::move(where), {left, 2}), texts);
}

}  // namespace

void bind_table(nb::module_& m) {
    m.def("plain_rows", &plain_rows, nb::arg("block"), nb::arg("cells"), nb::arg("columns"), nb::arg("required"),
          nb::arg("text") = -1, nb::arg("longest_text") = 256,
          "Read lines of so many cells each, separated by commas and not quoted; the last byte is a line feed. Numbers (n, k)"
          " of k columns, NaN for an empty cell; which of them (u,) int64, of all n k, are no plain decimals, whose values"
          " do not count; where these cells begin and end (u, 2) int64; and the cells of the column `text` (n, w) uint8, with"
          " zeros behind them, None for -1. None: a line has more cells or fewer, a cell is empty in a column that is"
          " `required`, or a text too long.");
}

}  // namespace contactbench::bindings

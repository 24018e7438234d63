// Rows of a table in text, and plain decimals in it to floats, each to the same bit as a correct conversion.
//
// Method: a decimal is W / 10^p with an integer W below 2^63 and an exact float 10^p. Where W is a float as well,
// one division is rounded once (Clinger, PLDI 1990). Otherwise the quotient of the rounded W is off by what the division
// and the rounding left over; that remainder is worked out exactly (Veltkamp & Dekker, Numer. Math. 18, 1971), divided as
// well, and added. The sum of the two is rounded as the true quotient is, unless that is all but halfway between two
// floats: such a cell is left to whoever can do it.
//
// Contract: no locale, no allocation but of the answer, no byte read outside the text.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace contactbench {

struct Decimal {
    double value = 0.0;
    bool sure = false;  // false: no plain decimal, too many digits, or too near the middle between two floats
};

namespace text {

constexpr std::uint64_t ones = 0x0101010101010101, high_bits = 0x8080808080808080;

inline std::uint64_t eight_bytes(const char* p) {
    std::uint64_t word;
    std::memcpy(&word, p, 8);
    if constexpr (std::endian::native == std::endian::big) word = __builtin_bswap64(word);
    return word;
}

// The high bit of each byte that is `c`.
constexpr std::uint64_t places(std::uint64_t word, char c) {
    const std::uint64_t other = word ^ (ones * std::uint8_t(c));
    return ~(((other & ~high_bits) + ~high_bits) | other) & high_bits;
}

// Adds the digits that begin at p to `value`, and returns what follows them. Of 20 digits or more `value` is nonsense.
inline const char* digits(const char* p, const char* last, std::uint64_t& value) {
    for (; last - p >= 8; p += 8) {
        std::uint64_t word = eight_bytes(p) ^ 0x3030303030303030;
        if (((word + 0x0606060606060606) | word) & 0xF0F0F0F0F0F0F0F0) break;
        word = (word * (1 + (10 << 8)) >> 8) & 0x00FF00FF00FF00FF;
        word = (word * (1 + (100 << 16)) >> 16) & 0x0000FFFF0000FFFF;
        word = word * (1 + (std::uint64_t(10'000) << 32)) >> 32;
        value = 100'000'000 * value + word;
    }
    for (; p < last && *p >= '0' && *p <= '9'; ++p) value = 10 * value + std::uint64_t(*p - '0');
    return p;
}

// x y - rounded product, exactly.
inline double product_error(double x, double y, double product) {
    constexpr double splitter = 134217729.0;  // 2^27 + 1
    const double bx = splitter * x, x_high = bx - (bx - x), x_low = x - x_high;
    const double by = splitter * y, y_high = by - (by - y), y_low = y - y_high;
    return ((x_high * y_high - product) + x_high * y_low + x_low * y_high) + x_low * y_low;
}

inline Decimal quotient(std::uint64_t whole, double power) {
    const double high = double(whole), first = high / power;
    if (whole < std::uint64_t(1) << 53) return {first, true};
    const double low = double(std::int64_t(whole) - std::int64_t(high)), product = first * power;
    const double rest = ((high - product) - product_error(first, power, product) + low) / power;
    const double total = first + rest, lost = std::fabs(rest - (total - first));
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(total), mantissa = (std::uint64_t(1) << 52) - 1;
    // The distance to the next float is that of the power of two below, times 2^-52. From a power of two, that to
    // the one below is half as large: left out.
    const double half = 0x1p-53 * std::bit_cast<double>(bits & ~mantissa);
    return {total, ((bits & mantissa) != 0 && lost < 0.999 * half) || (rest == 0.0 && low == 0.0)};
}

}  // namespace text

// A cell of a minus or none, digits, and perhaps a point and digits.
inline Decimal to_decimal(const char* first, const char* last) {
    static constexpr std::ptrdiff_t most_digits = 18;  // of these an int64 holds any
    static constexpr std::array<double, 23> powers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                                   1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    const bool minus = first < last && *first == '-';
    const char* begin = first + minus;
    std::uint64_t whole = 0;
    const char* end = text::digits(begin, last, whole);
    std::ptrdiff_t count = end - begin, after = 0;
    if (count == 0 || count > most_digits) return {};
    if (end < last) {
        if (*end != '.') return {};
        if (whole == 0) count = 0;  // zeros in front say nothing
        const char* point = end;
        end = text::digits(point + 1, last, whole);
        after = end - point - 1;
        if (after == 0 || end != last || after >= std::ptrdiff_t(powers.size())) return {};
        // All but the last 18 of those behind a point may be zeros too.
        if (count == 0)
            for (const char* p = point + 1; count + after > most_digits && *p == '0'; ++p) --count;
        count += after;
    }
    if (count > most_digits) return {};
    Decimal found = text::quotient(whole, powers[std::size_t(after)]);
    if (minus) found.value = -found.value;
    return found;
}

// What is read of a table: columns of numbers, and perhaps one of text. Cells are separated by commas and not quoted.
struct Layout {
    std::size_t cells = 1;              // of every row
    std::vector<std::size_t> columns;   // below `cells`
    std::vector<std::uint8_t> required;  // of each of these columns: whether no cell may be empty; NaN stands for one
    std::size_t text = none;            // a column, or none

    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
};

struct Span {
    std::size_t first, last;
};

struct PlainRows {
    std::size_t count = 0;
    std::vector<double> numbers;      // of each row one per column
    std::vector<std::size_t> unsure;  // places in `numbers` of cells that are no plain decimals
    std::vector<Span> where;          // of each of these
    std::vector<Span> texts;          // of each row
};

// Read the lines [begin, end) of a text, of which the last byte is a line feed. False: some row has more cells or
// fewer, or an empty one where it must not be.
inline bool read_plain(const char* data, std::size_t begin, std::size_t end, const Layout& layout, PlainRows& out) {
    if (layout.cells > end - begin) return begin == end;  // more than any line here can have, or memory
    std::vector<std::size_t> ends(layout.cells + 1);  // ends[c] is where cell c - 1 ends, which is before cell c begins
    ends[0] = begin - 1;
    std::size_t cell = 0;
    const auto row = [&] {
        for (std::size_t k = 0; k < layout.columns.size(); ++k) {
            const std::size_t first = ends[layout.columns[k]] + 1, last = ends[layout.columns[k] + 1];
            if (first == last) {
                if (layout.required[k]) return false;
                out.numbers.push_back(std::numeric_limits<double>::quiet_NaN());
                continue;
            }
            const Decimal found = to_decimal(data + first, data + last);
            if (!found.sure) {
                out.unsure.push_back(out.numbers.size());
                out.where.push_back({first, last});
            }
            out.numbers.push_back(found.value);
        }
        if (layout.text != Layout::none) out.texts.push_back({ends[layout.text] + 1, ends[layout.text + 1]});
        ++out.count;
        return true;
    };
    const auto mark = [&](std::size_t at) {
        if (cell == layout.cells) return false;
        ends[++cell] = at;
        if (data[at] == ',') return true;
        if (cell != layout.cells || !row()) return false;
        ends[0] = at;
        cell = 0;
        return true;
    };
    std::size_t at = begin;
    for (; at + 8 <= end; at += 8) {
        const std::uint64_t word = text::eight_bytes(data + at);
        for (std::uint64_t found = text::places(word, ',') | text::places(word, '\n'); found; found &= found - 1)
            if (!mark(at + std::size_t(std::countr_zero(found)) / 8)) return false;
    }
    for (; at < end; ++at)
        if ((data[at] == ',' || data[at] == '\n') && !mark(at)) return false;
    return true;
}

}  // namespace contactbench

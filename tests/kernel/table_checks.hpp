// Decimals beside the C library's conversion, and rows of a table beside cutting at every comma.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "check.hpp"
#include "contactbench/table.hpp"

namespace testing {

// Mostly plain: few digits, as many as a float has, or more; now and then something else.
inline std::string cell(Random& random) {
    std::string text = random.below(4) == 0 ? "-" : "";
    const auto append = [&](std::size_t count) {
        const bool zeros = random.below(3) == 0;
        for (std::size_t i = 0; i < count; ++i) text += char('0' + (zeros && i + 1 < count ? 0 : random.below(10)));
    };
    append(random.below(random.below(4) == 0 ? 26 : 6));
    if (random.below(5) != 0) {
        text += '.';
        append(random.below(random.below(4) == 0 ? 26 : 18));
    }
    if (random.below(12) == 0) text.insert(random.below(text.size() + 1), 1, "+-. e_x/:\xB5"[random.below(10)]);
    return text;
}

inline bool plain(const std::string& text) {
    const std::size_t begin = !text.empty() && text[0] == '-', point = std::min(text.find('.'), text.size());
    if (point == begin || point + 1 == text.size()) return false;
    for (std::size_t i = begin; i < text.size(); ++i)
        if (i != point && (text[i] < '0' || text[i] > '9')) return false;
    return true;
}

inline void check_decimals() {
    Random random(30);
    long sure = 0;
    for (int round = 0; round < 200'000; ++round) {
        const std::string text = cell(random);
        const contactbench::Decimal found = contactbench::to_decimal(text.data(), text.data() + text.size());
        if (!found.sure) continue;
        ++sure;
        CHECK(plain(text));
        const double expected = std::strtod(text.c_str(), nullptr);
        CHECK(found.value == expected && std::signbit(found.value) == std::signbit(expected));
    }
    CHECK(sure > 100'000);
    // In the middle of two floats, and the least beside it that 18 digits can be: none may be guessed.
    for (std::uint64_t odd = 1; odd < 2'000; odd += 2)
        for (int step = -1; step <= 1; ++step) {
            const std::uint64_t tenths = 10 * ((std::uint64_t(1) << 53) + odd) + std::uint64_t(step);
            const std::string text = std::to_string(tenths / 10) + "." + std::to_string(tenths % 10);
            const contactbench::Decimal found = contactbench::to_decimal(text.data(), text.data() + text.size());
            CHECK(!found.sure || found.value == std::strtod(text.c_str(), nullptr));
        }
    for (const char* text : {"", "-", ".", ".5", "5.", "1..2", "1.2.3", "--1", "+1", "1e5", "18446744073709551616",
                             "18446744073709551616.5", "0.00000000000000000000001"})
        CHECK(!contactbench::to_decimal(text, text + std::strlen(text)).sure);
    for (const char* text : {"0", "-0", "-0.0", "00012.50", "0.0000000000000000000123", "999999999999999999"}) {
        const contactbench::Decimal found = contactbench::to_decimal(text, text + std::strlen(text));
        CHECK(found.sure && found.value == std::strtod(text, nullptr) && std::signbit(found.value) == (text[0] == '-'));
    }
}

inline void check_rows() {
    for (const std::size_t cells : {std::size_t(4), std::size_t(-1)}) {
        const contactbench::Layout layout{cells, {0}, {0}};
        contactbench::PlainRows out;
        CHECK(!contactbench::read_plain("1,\n", 0, 3, layout, out));
        CHECK(contactbench::read_plain("1,\n", 3, 3, layout, out) && out.count == 0);
    }
    Random random(31);
    for (int round = 0; round < 3'000; ++round) {
        const std::size_t cells = 1 + random.below(4), rows = random.below(6);
        contactbench::Layout layout{cells, {}, {}, random.below(2) ? random.below(cells) : contactbench::Layout::none};
        for (std::size_t k = 1 + random.below(3); k > 0; --k) {
            layout.columns.push_back(random.below(cells));
            layout.required.push_back(std::uint8_t(random.below(2)));
        }
        const std::string before = random.below(2) ? "9,9\n" : "";
        std::string data = before;
        std::vector<std::vector<std::string>> expected;
        bool good = true;
        for (std::size_t r = 0; r < rows; ++r) {
            std::vector<std::string> row;
            for (std::size_t c = 0; c < cells; ++c) row.push_back(random.below(6) == 0 ? "" : cell(random));
            for (std::size_t c = 0; c < cells; ++c) data += (c ? "," : "") + row[c];
            if (random.below(60) == 0) data += ",", good = false;
            else if (random.below(60) == 0 && cells > 1) data.erase(data.rfind(',')), good = false;
            data += '\n';
            for (std::size_t k = 0; k < layout.columns.size(); ++k)
                if (layout.required[k] && row[layout.columns[k]].empty()) good = false;
            expected.push_back(std::move(row));
        }
        // As long as it is, so that a byte read behind it is seen.
        const std::vector<char> exact(data.begin(), data.end());
        contactbench::PlainRows out;
        const bool read = contactbench::read_plain(exact.data(), before.size(), exact.size(), layout, out);
        if (!CHECK(read == good) || !good) continue;
        const std::size_t wide = layout.columns.size();
        CHECK(out.count == rows && out.numbers.size() == rows * wide && out.unsure.size() == out.where.size());
        std::size_t left = 0;
        for (std::size_t i = 0; i < out.numbers.size(); ++i) {
            const std::string& text = expected[i / wide][layout.columns[i % wide]];
            if (left < out.unsure.size() && out.unsure[left] == i) {
                const contactbench::Span where = out.where[left++];
                CHECK(data.substr(where.first, where.last - where.first) == text && !text.empty());
            } else {
                CHECK(text.empty() ? std::isnan(out.numbers[i]) : out.numbers[i] == std::strtod(text.c_str(), nullptr));
            }
        }
        CHECK(left == out.unsure.size() && out.texts.size() == (layout.text == contactbench::Layout::none ? 0 : rows));
        for (std::size_t r = 0; r < out.texts.size(); ++r)
            CHECK(data.substr(out.texts[r].first, out.texts[r].last - out.texts[r].first) == expected[r][layout.text]);
    }
}

}  // namespace testing

#include "json.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

namespace contactbench::runtime {

namespace {

constexpr int deepest = 32;

void append_utf8(std::string& out, std::uint32_t code) {
    if (code < 0x80) {
        out += char(code);
    } else if (code < 0x800) {
        out += char(0xC0 | code >> 6), out += char(0x80 | (code & 63));
    } else if (code < 0x10000) {
        out += char(0xE0 | code >> 12), out += char(0x80 | (code >> 6 & 63)), out += char(0x80 | (code & 63));
    } else {
        out += char(0xF0 | code >> 18), out += char(0x80 | (code >> 12 & 63));
        out += char(0x80 | (code >> 6 & 63)), out += char(0x80 | (code & 63));
    }
}

class Parser {
public:
    explicit Parser(std::string_view text) : text_(text) {}

    Json document() {
        Json value = parse(0);
        space();
        if (at_ != text_.size()) fail("something follows the end of the object");
        return value;
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw LoadError(CB_ERROR_JSON, "contactbench.json: byte " + std::to_string(at_) + ": " + what +
                                           "; export the bundle again");
    }

    char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

    void space() {
        while (at_ < text_.size() && std::string_view(" \t\n\r").find(text_[at_]) != std::string_view::npos) ++at_;
    }

    void expect(char c) {
        if (peek() != c) fail(std::string("'") + c + "' is missing");
        ++at_;
    }

    bool take(char c) {
        space();
        if (at_ >= text_.size() || text_[at_] != c) return false;
        ++at_;
        return true;
    }

    void word(std::string_view name) {
        if (text_.substr(at_, name.size()) != name) fail("neither a value nor null, true or false");
        at_ += name.size();
    }

    Json parse(int depth) {
        if (depth > deepest) fail("nested too deeply");
        space();
        Json v;
        switch (peek()) {
            case '{': object(v, depth); break;
            case '[': array(v, depth); break;
            case '"': v.type = Json::Type::text, v.text = text(); break;
            case 't': word("true"), v.type = Json::Type::boolean, v.boolean = true; break;
            case 'f': word("false"), v.type = Json::Type::boolean; break;
            case 'n': word("null"); break;
            default: number(v);
        }
        return v;
    }

    void object(Json& v, int depth) {
        v.type = Json::Type::object;
        expect('{');
        if (take('}')) return;
        do {
            space();
            std::string key = text();
            space();
            expect(':');
            v.members.push_back({std::move(key), parse(depth + 1)});
        } while (take(','));
        expect('}');
        std::vector<std::string_view> names;
        for (const auto& member : v.members) names.push_back(member.name);
        std::sort(names.begin(), names.end());
        if (std::adjacent_find(names.begin(), names.end()) != names.end()) fail("a key occurs twice");
    }

    void array(Json& v, int depth) {
        v.type = Json::Type::array;
        expect('[');
        if (take(']')) return;
        do v.items.push_back(parse(depth + 1));
        while (take(','));
        expect(']');
    }

    bool digit() const { return peek() >= '0' && peek() <= '9'; }

    void digits() {
        if (!digit()) fail("not a number");
        while (digit()) ++at_;
    }

    // The grammar is checked first: from_chars would take more than JSON allows.
    void number(Json& v) {
        const std::size_t from = at_;
        bool whole = true;
        if (peek() == '-') ++at_;
        if (peek() == '0')
            ++at_;
        else
            digits();
        if (peek() == '.') whole = false, ++at_, digits();
        if (peek() == 'e' || peek() == 'E') {
            whole = false;
            ++at_;
            if (peek() == '+' || peek() == '-') ++at_;
            digits();
        }
        const char *first = text_.data() + from, *last = text_.data() + at_;
        const auto read = std::from_chars(first, last, v.number);
        if (read.ec != std::errc() || read.ptr != last || !std::isfinite(v.number))
            fail("a number that no double holds");
        const bool fits = whole && std::from_chars(first, last, v.integer).ec == std::errc();
        v.type = fits ? Json::Type::integer : Json::Type::number;
    }

    std::string text() {
        expect('"');
        std::string out;
        for (;;) {
            if (at_ >= text_.size()) fail("a text without its end");
            const unsigned char c = static_cast<unsigned char>(text_[at_]);
            if (c == '"') break;
            if (c < 0x20) fail("a control character in a text");
            if (c == '\\')
                escape(out);
            else if (c < 0x80)
                out += text_[at_++];
            else
                multibyte(out);
        }
        ++at_;
        return out;
    }

    void escape(std::string& out) {
        ++at_;
        static constexpr std::string_view from = "\"\\/bfnrt", to = "\"\\/\b\f\n\r\t";
        const char c = peek();
        const std::size_t i = c ? from.find(c) : std::string_view::npos;
        if (i != std::string_view::npos) {
            out += to[i];
            ++at_;
        } else if (c == 'u') {
            ++at_;
            append_utf8(out, code_point());
        } else {
            fail("an unknown escape");
        }
    }

    std::uint32_t code_point() {
        const std::uint32_t high = hex4();
        if (high < 0xD800 || high > 0xDFFF) return high;
        if (high > 0xDBFF || text_.substr(at_, 2) != "\\u") fail("half a surrogate pair");
        at_ += 2;
        const std::uint32_t low = hex4();
        if (low < 0xDC00 || low > 0xDFFF) fail("half a surrogate pair");
        return 0x10000 + ((high - 0xD800) << 10) + (low - 0xDC00);
    }

    std::uint32_t hex4() {
        if (text_.size() - at_ < 4) fail("an escape is cut short");
        std::uint32_t code = 0;
        const char* first = text_.data() + at_;
        const auto read = std::from_chars(first, first + 4, code, 16);
        if (read.ec != std::errc() || read.ptr != first + 4) fail("an escape is not hexadecimal");
        at_ += 4;
        return code;
    }

    void multibyte(std::string& out) {
        const auto byte = [&](std::size_t i) {
            return at_ + i < text_.size() ? static_cast<unsigned char>(text_[at_ + i]) : 0u;
        };
        const std::uint32_t lead = byte(0);
        const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
        if (lead < 0xC2 || lead > 0xF4) fail("not UTF-8");
        std::uint32_t code = lead & (0xFFu >> (length + 1));
        for (std::size_t i = 1; i < length; ++i) {
            if ((byte(i) & 0xC0) != 0x80) fail("not UTF-8");
            code = code << 6 | (byte(i) & 63);
        }
        const bool overlong = code < (length == 4 ? 0x10000u : length == 3 ? 0x800u : 0x80u);
        if (overlong || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) fail("not UTF-8");
        out.append(text_.substr(at_, length));
        at_ += length;
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

void write_text(std::string& out, std::string_view text) {
    static constexpr std::string_view from = "\"\\\b\f\n\r\t", to = "\"\\bfnrt";
    out += '"';
    for (const char c : text) {
        const std::size_t i = from.find(c);
        if (i != std::string_view::npos)
            (out += '\\') += to[i];
        else if (static_cast<unsigned char>(c) < 0x20)
            ((out += "\\u00") += c < 0x10 ? '0' : '1') += "0123456789abcdef"[c & 15];
        else
            out += c;
    }
    out += '"';
}

void write(std::string& out, const Json& v) {
    const char* between = "";
    switch (v.type) {
        case Json::Type::null: out += "null"; break;
        case Json::Type::boolean: out += v.boolean ? "true" : "false"; break;
        case Json::Type::integer: out += std::to_string(v.integer); break;
        case Json::Type::number: out += repr(v.number); break;
        case Json::Type::text: write_text(out, v.text); break;
        case Json::Type::array:
            out += '[';
            for (const Json& item : v.items) write(out += std::exchange(between, ","), item);
            out += ']';
            break;
        case Json::Type::object: {
            std::vector<const JsonMember*> sorted;
            for (const auto& member : v.members) sorted.push_back(&member);
            std::sort(sorted.begin(), sorted.end(), [](auto a, auto b) { return a->name < b->name; });
            out += '{';
            for (const auto* member : sorted) {
                write_text(out += std::exchange(between, ","), member->name);
                write(out += ':', member->value);
            }
            out += '}';
        }
    }
}

}  // namespace

const Json* Json::find(std::string_view key) const {
    for (const JsonMember& member : members)
        if (member.name == key) return &member.value;
    return nullptr;
}

Json parse_json(std::string_view text) { return Parser(text).document(); }

std::string encode_json(const Json& value) {
    std::string out;
    write(out, value);
    return out += '\n';
}

std::string repr(double x) {
    char text[64];
    const auto written = [&](std::chars_format format) {
        return std::string_view(text, std::size_t(std::to_chars(text, text + sizeof text, x, format).ptr - text));
    };
    const std::string_view digits = written(std::chars_format::scientific);
    const std::string_view exponent = digits.substr(std::min(digits.find('e'), digits.size() - 1) + 1);
    int e = 0;
    std::from_chars(exponent.data() + (exponent[0] == '+'), exponent.data() + exponent.size(), e);
    if (e < -4 || e >= 16) return std::string(digits);
    std::string out(written(std::chars_format::fixed));
    return out.find('.') == std::string::npos ? out + ".0" : out;
}

std::size_t first_difference(std::string_view one, std::string_view other) {
    return std::size_t(std::mismatch(one.begin(), one.end(), other.begin(), other.end()).first - one.begin());
}

}  // namespace contactbench::runtime

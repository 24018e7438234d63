#include "ply.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

namespace contactbench::runtime {

static_assert(std::endian::native == std::endian::little, "the numbers of the file are read as they stand");

namespace {

constexpr std::size_t vertex_bytes = 3 * 8, face_bytes = 1 + 3 * 4 + 4 + 1 + 3;
constexpr std::size_t most = 2'000'000;

constexpr std::string_view untouchable_line = "comment untouchable regions";
constexpr std::string_view vertex_lines[] = {"property double x", "property double y", "property double z"};
constexpr std::string_view face_lines[] = {"property list uchar int vertex_indices", "property int region",
                                           "property uchar invented", "property uchar red",
                                           "property uchar green", "property uchar blue"};

class Reader {
public:
    Reader(std::string_view data, const std::string& name) : data_(data), name_(name) {}

    [[noreturn]] void fail(const std::string& what) const {
        throw LoadError(CB_ERROR_MESH, name_ + ": " + what + "; export the bundle again");
    }

    ProbeMesh read() {
        expect("ply");
        expect("format binary_little_endian 1.0");
        const std::size_t vertices = count("element vertex ");
        for (const std::string_view l : vertex_lines) expect(l);
        const std::size_t faces = count("element face ");
        for (const std::string_view l : face_lines) expect(l);
        expect("end_header");
        if (data_.size() - at_ != vertices * vertex_bytes + faces * face_bytes)
            fail("its length does not fit its header: cut short, or something follows");
        ProbeMesh mesh;
        mesh.untouchable = untouchable_;
        read_vertices(mesh, vertices);
        read_faces(mesh, faces);
        return mesh;
    }

private:
    std::string_view line() {
        for (;;) {
            const std::size_t end = data_.substr(0, 4096).find('\n', at_);
            if (end == std::string_view::npos) fail("the header has no end");
            const std::string_view text = data_.substr(at_, end - at_);
            at_ = end + 1;
            if (text.substr(0, 8) != "comment ") return text;
            if (text.substr(0, untouchable_line.size()) == untouchable_line)
                untouchable_ += text.substr(untouchable_line.size());
        }
    }

    void expect(std::string_view wanted) {
        if (line() != wanted) fail("the header lacks '" + std::string(wanted) + "' where it belongs");
    }

    std::size_t count(std::string_view prefix) {
        const std::string_view text = line();
        std::size_t n = 0;
        const char *first = text.data() + std::min(prefix.size(), text.size()), *last = text.data() + text.size();
        const auto read = std::from_chars(first, last, n);
        if (text.substr(0, prefix.size()) != prefix || read.ec != std::errc() || read.ptr != last || n > most || n < 4)
            fail(std::string(prefix) + "needs a count from 4 to " + std::to_string(most));
        return n;
    }

    template <class T>
    T take() {
        T value;
        std::memcpy(&value, data_.data() + at_, sizeof value);
        at_ += sizeof value;
        return value;
    }

    void read_vertices(ProbeMesh& mesh, std::size_t n) {
        mesh.vertices.resize(n);
        for (std::size_t i = 0; i < n; ++i) {
            for (double* x : {&mesh.vertices[i].x, &mesh.vertices[i].y, &mesh.vertices[i].z}) {
                *x = take<double>();
                if (!(std::fabs(*x) <= 1e3)) fail("vertex " + std::to_string(i) + " is not a place on a probe");
            }
        }
    }

    void read_faces(ProbeMesh& mesh, std::size_t n) {
        mesh.faces.resize(n);
        mesh.region.resize(n);
        for (std::size_t f = 0; f < n; ++f) {
            const std::string facet = "facet " + std::to_string(f);
            if (take<unsigned char>() != 3) fail(facet + " is not a triangle");
            for (std::int32_t& v : mesh.faces[f]) {
                v = take<std::int32_t>();
                if (v < 0 || std::size_t(v) >= mesh.vertices.size()) fail(facet + " names a vertex that is not there");
            }
            mesh.region[f] = take<std::int32_t>();
            if (mesh.region[f] < 0 || mesh.region[f] > 1000) fail(facet + " has region " + std::to_string(mesh.region[f]));
            if (take<unsigned char>() > 1) fail(facet + ": invented is neither 0 nor 1");
            at_ += 3;  // its colour
        }
    }

    std::string_view data_;
    const std::string& name_;
    std::string untouchable_;
    std::size_t at_ = 0;
};

}  // namespace

ProbeMesh read_probe(std::string_view data, const std::string& name) { return Reader(data, name).read(); }

}  // namespace contactbench::runtime

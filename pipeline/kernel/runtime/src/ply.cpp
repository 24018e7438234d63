#include "ply.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

namespace contactbench::runtime {

static_assert(std::endian::native == std::endian::little, "the numbers of the file are read as they stand");

namespace {

constexpr std::size_t vertex_bytes = 3 * 8, face_bytes = 1 + 3 * 4 + 4 + 1 + 3;

using Colour = std::array<unsigned, 3>;
constexpr Colour plain{0xc8, 0xc8, 0xc8}, invented_colour{0x46, 0x46, 0x46};

Colour to_colour(std::string_view text) {
    Colour out{};
    for (std::size_t i = 0; i < 3; ++i)
        std::from_chars(text.data() + 1 + 2 * i, text.data() + 3 + 2 * i, out[i], 16);
    return out;
}

std::string header_of(const Config& c) {
    std::string untouchable;
    for (const RegionRow& region : c.regions)
        if (region.untouchable) (untouchable += ' ') += std::to_string(region.rank);
    if (!untouchable.empty()) untouchable = "comment untouchable regions" + untouchable + "\n";
    return "ply\nformat binary_little_endian 1.0\ncomment contactbench probe 1\ncomment metres\n" + untouchable +
           "element vertex " + std::to_string(c.vertices) +
           "\nproperty double x\nproperty double y\nproperty double z\nelement face " + std::to_string(c.facets) +
           "\nproperty list uchar int vertex_indices\nproperty int region\nproperty uchar invented\n"
           "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
}

class Reader {
public:
    Reader(std::string_view data, const Config& config, const std::vector<std::string>& colours)
        : data_(data), config_(config), colours_{plain} {
        for (const std::string& colour : colours) colours_.push_back(to_colour(colour));
    }

    ProbeMesh read() {
        const std::string header = header_of(config_);
        if (data_.substr(0, header.size()) != header)
            fail("the header is not that of probe.facets, probe.vertices and the untouchable regions");
        if (data_.size() != header.size() + config_.vertices * vertex_bytes + config_.facets * face_bytes)
            fail("its length does not fit its header: cut short, or something follows");
        at_ = header.size();
        ProbeMesh mesh;
        read_vertices(mesh);
        read_faces(mesh);
        return mesh;
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw LoadError(CB_ERROR_MESH, config_.probe_file + ": " + what + "; export the bundle again");
    }

    template <class T>
    T take() {
        T value;
        std::memcpy(&value, data_.data() + at_, sizeof value);
        at_ += sizeof value;
        return value;
    }

    void read_vertices(ProbeMesh& mesh) {
        mesh.vertices.resize(config_.vertices);
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
            for (double* x : {&mesh.vertices[i].x, &mesh.vertices[i].y, &mesh.vertices[i].z}) {
                *x = take<double>();
                if (!(std::fabs(*x) <= 1e3)) fail("vertex " + std::to_string(i) + " is not a place on a probe");
            }
        }
    }

    void read_faces(ProbeMesh& mesh) {
        mesh.faces.resize(config_.facets);
        mesh.region.resize(config_.facets);
        mesh.invented.resize(config_.facets);
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            const std::string facet = "facet " + std::to_string(f);
            if (take<unsigned char>() != 3) fail(facet + " is not a triangle");
            for (std::int32_t& v : mesh.faces[f]) {
                v = take<std::int32_t>();
                if (v < 0 || std::size_t(v) >= mesh.vertices.size()) fail(facet + " names a vertex that is not there");
            }
            const std::int32_t region = mesh.region[f] = take<std::int32_t>();
            if (region < 0 || std::size_t(region) >= colours_.size())
                fail(facet + " has region " + std::to_string(region) + ", which regions does not list");
            const std::uint8_t invented = mesh.invented[f] = take<std::uint8_t>();
            if (invented > 1) fail(facet + ": invented is neither 0 nor 1");
            for (std::size_t i = 0; i < 3; ++i)
                if (take<unsigned char>() != shade(std::size_t(region), invented, i)) fail(facet + " has another colour");
        }
    }

    // Half of each for what was made up in a region; as contactbench.pipeline.mesh.colours has it.
    unsigned shade(std::size_t region, bool invented, std::size_t i) const {
        if (!invented) return colours_[region][i];
        return region > 0 ? (colours_[region][i] + invented_colour[i]) / 2 : invented_colour[i];
    }

    std::string_view data_;
    const Config& config_;
    std::vector<Colour> colours_;  // by region
    std::size_t at_ = 0;
};

}  // namespace

ProbeMesh read_probe(std::string_view data, const Config& config, const std::vector<std::string>& colours) {
    return Reader(data, config, colours).read();
}

}  // namespace contactbench::runtime

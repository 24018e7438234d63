#include "tables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>

#include "json.hpp"

namespace contactbench::runtime {

namespace {

constexpr std::string_view header = "index,nx,ny,nz,d,region,x1,y1,z1,x2,y2,z2,x3,y3,z3\n";
constexpr double thinnest = 64 * std::numeric_limits<double>::epsilon();  // height over the largest coordinate

std::vector<std::size_t> priority_order(const ProbeMesh& mesh, const Config& config) {
    std::vector<std::size_t> order(mesh.faces.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    // Those of no region come late, untouchable ones last.
    const auto rank = [&](std::size_t f) {
        const std::size_t region = std::size_t(mesh.region[f]);
        if (region == 0) return config.regions.size() + 1;
        return config.regions[region - 1].untouchable ? config.regions.size() + 2 : region;
    };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
    return order;
}

// The power of two that makes every coordinate at most 1: dividing by it rounds nothing.
double scale_of(const ProbeMesh& mesh) {
    double most = 0.0;
    for (const Triangle& t : mesh.faces)
        for (const std::int32_t v : t) {
            const Vec3& p = mesh.vertices[std::size_t(v)];
            most = std::max({most, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
        }
    int exponent = 0;
    std::frexp(most, &exponent);
    return std::ldexp(1.0, exponent);
}

void append(std::string& line, Vec3 v) {
    for (const double x : {v.x, v.y, v.z}) (line += ',') += repr(x);
}

// Every operation in the order of contactbench.pipeline.config.runtime.planes and contactbench.pipeline.mesh.probe: the same bits.
std::string line_of(std::size_t facet, const ProbeMesh& mesh, double scale) {
    Vec3 p[3], q[3];
    for (std::size_t c = 0; c < 3; ++c) {
        p[c] = mesh.vertices[std::size_t(mesh.faces[facet][c])];
        q[c] = {p[c].x / scale, p[c].y / scale, p[c].z / scale};
    }
    const Vec3 area = cross(q[1] - q[0], q[2] - q[0]);
    const double size = norm(area);
    const double longest = std::max({norm(q[1] - q[0]), norm(q[2] - q[1]), norm(q[0] - q[2])});
    if (!(size > thinnest * longest))
        refuse_file(CB_ERROR_MESH, "probe.ply", "facet " + std::to_string(facet) + " has no area");
    const Vec3 n{area.x / size, area.y / size, area.z / size};
    const Vec3 sum = p[0] + p[1] + p[2];
    const double d = -(n.x * (sum.x / 3.0) + n.z * (sum.z / 3.0) + n.y * (sum.y / 3.0));
    std::string line = std::to_string(facet);
    append(line, n);
    (line += ',') += repr(d);
    (line += ',') += std::to_string(mesh.region[facet]);
    for (const Vec3& corner : p) append(line, corner);
    return line += '\n';
}

}  // namespace

void check_planes(const std::string& table, const ProbeMesh& mesh, const Config& config) {
    if (config.planes != mesh.faces.size())
        refuse_file(CB_ERROR_MESH, planes_name, "planes.count is not the number of facets");
    const double scale = scale_of(mesh);
    std::size_t at = 0, number = 0;
    const auto expect = [&](std::string_view line) {
        ++number;
        if (std::string_view(table).substr(at, line.size()) != line)
            refuse_file(CB_ERROR_MESH, planes_name, "line " + std::to_string(number) + " is not that of the mesh");
        at += line.size();
    };
    expect(header);
    for (const std::size_t facet : priority_order(mesh, config)) expect(line_of(facet, mesh, scale));
    if (at != table.size()) refuse_file(CB_ERROR_MESH, planes_name, "something follows the last facet");
}

}  // namespace contactbench::runtime

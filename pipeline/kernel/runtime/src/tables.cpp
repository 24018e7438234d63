#include "tables.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <string_view>

namespace contactbench::runtime {

namespace {

constexpr std::string_view header = "index,nx,ny,nz,d,region,x1,y1,z1,x2,y2,z2,x3,y3,z3";
constexpr std::size_t columns = 15;
constexpr double rounding = 1e-9;  // normals are computed anew

std::string_view take(std::string_view& text, char end) {
    const std::size_t at = std::min(text.find(end), text.size());
    const std::string_view part = text.substr(0, at);
    text.remove_prefix(std::min(at + 1, text.size()));
    return part;
}

bool to_double(std::string_view text, double& out) {
    const auto read = std::from_chars(text.data(), text.data() + text.size(), out);
    return read.ec == std::errc() && read.ptr == text.data() + text.size() && std::isfinite(out);
}

bool numbers_of(std::string_view text, double* out, std::size_t count, bool spaced) {
    for (std::size_t i = 0; i < count; ++i) {
        const bool last = i + 1 == count;
        if (!last && text.find(',') == std::string_view::npos) return false;
        std::string_view cell = last ? text : take(text, ',');
        if (i > 0 && spaced && !cell.empty() && cell.front() == ' ') cell.remove_prefix(1);
        if (!to_double(cell, out[i])) return false;
    }
    return true;
}

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

bool is_plane(const double* row, std::size_t facet, const ProbeMesh& mesh) {
    Vec3 corner[3];
    for (std::size_t c = 0; c < 3; ++c) corner[c] = mesh.vertices[std::size_t(mesh.faces[facet][c])];
    for (std::size_t c = 0; c < 3; ++c)
        if (row[6 + 3 * c] != corner[c].x || row[7 + 3 * c] != corner[c].y || row[8 + 3 * c] != corner[c].z) return false;
    const Vec3 area = cross(corner[1] - corner[0], corner[2] - corner[0]);
    const Vec3 n = (1.0 / norm(area)) * area;
    const double d = -dot(n, (1.0 / 3.0) * (corner[0] + corner[1] + corner[2]));
    const auto near = [](double a, double b) { return std::fabs(a - b) <= rounding; };
    return row[0] == double(facet) && row[5] == double(mesh.region[facet]) && near(row[1], n.x) && near(row[2], n.y) &&
           near(row[3], n.z) && near(row[4], d);
}

using Lines = std::vector<std::string_view>;

Lines lines_of(const std::string& file, std::string_view text) {
    if (std::any_of(text.begin(), text.end(), [](unsigned char c) { return c > 127; }))
        refuse_file(CB_ERROR_VALUE, file, "not ASCII");
    Lines lines;
    while (!text.empty()) lines.push_back(take(text, '\n'));
    return lines;
}

// What follows `key` in every line that starts with it, spaces in front included.
std::vector<double> values_of(const Lines& lines, std::string_view key) {
    std::vector<double> found;
    for (const std::string_view line : lines) {
        double x = std::nan("");
        if (line.substr(0, key.size()) != key) continue;
        found.push_back(to_double(line.substr(key.size()), x) ? x : std::nan(""));
    }
    return found;
}

// The numbers of the one line `key: [..]`, however far it is indented.
std::vector<double> list_of(const Lines& lines, const std::string& key, std::size_t count) {
    std::vector<double> found;
    for (std::string_view line : lines) {
        line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
        const std::string start = key + ": [";
        if (line.substr(0, start.size()) != start || line.back() != ']') continue;
        if (!found.empty()) return {};
        found.resize(count);
        if (!numbers_of(line.substr(start.size(), line.size() - start.size() - 1), found.data(), count, true)) return {};
    }
    return found;
}

void check(const std::string& file, const char* what, const std::vector<double>& told, std::vector<double> wanted) {
    if (told != wanted)
        refuse_file(CB_ERROR_VALUE, file + ": " + what, "not what gravity in contactbench.json says");
}

std::vector<double> joined(Vec3 a, Vec3 b) { return {a.x, a.y, a.z, b.x, b.y, b.z}; }

}  // namespace

void check_planes(const std::string& table, const ProbeMesh& mesh, const Config& config) {
    if (config.planes != mesh.faces.size())
        refuse_file(CB_ERROR_MESH, planes_name, "planes.count is not the number of facets");
    std::string_view rest = table;
    if (take(rest, '\n') != header) refuse_file(CB_ERROR_MESH, planes_name, "the header is another one");
    std::size_t line = 1;
    for (const std::size_t facet : priority_order(mesh, config)) {
        double row[columns] = {};
        ++line;
        if (!numbers_of(take(rest, '\n'), row, columns, false) || !is_plane(row, facet, mesh))
            refuse_file(CB_ERROR_MESH, planes_name,
                        "line " + std::to_string(line) + " is not the plane of facet " + std::to_string(facet) +
                            ", which belongs there");
    }
    if (!rest.empty() || table.back() != '\n')
        refuse_file(CB_ERROR_MESH, planes_name, "it is cut short, or something follows the last facet");
}

void check_gravity_files(const Files& files, const GravityLoad& g) {
    const Lines lines = lines_of(ros2_name, files.at(ros2_name));
    const std::vector<double> bias = joined(g.force_bias, g.torque_bias);
    // The offset is added to the reading; the multipliers of x, y and z follow it.
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::string key = std::string(8, ' ') + "xyz"[axis] + ": ";
        check(ros2_name, "offset", values_of(lines, key), {-bias[axis], -bias[axis + 3], 1.0, 1.0});
    }
    check(ros2_name, "CoG.pos", list_of(lines, "pos", 3),
          {g.centre_of_mass_S.x, g.centre_of_mass_S.y, g.centre_of_mass_S.z});
    check(ros2_name, "CoG.force", values_of(lines, std::string(8, ' ') + "force: "), {std::max(-g.gravity_W.z, 0.0)});
    const auto ft_calib = files.find(ft_calib_name);
    if (ft_calib != files.end())
        check(ft_calib_name, "bias", list_of(lines_of(ft_calib_name, ft_calib->second), "bias", 6), bias);
}

}  // namespace contactbench::runtime

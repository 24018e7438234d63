#include "bundle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "folder.hpp"
#include "physics.hpp"
#include "ply.hpp"
#include "sha256.hpp"

namespace contactbench::runtime {

namespace {

constexpr double flat = 1e-12;  // of the cube about a probe: less volume is rounding
constexpr double thinnest = 64 * std::numeric_limits<double>::epsilon();  // height over the largest coordinate

void check_hashes(const Files& files, const Config& c) {
    std::size_t listed = 0;
    for (const auto& [name, hash] : c.files) {
        const auto file = files.find(name);
        if (file == files.end() || name == config_name || name == checksum_name)
            refuse_file(CB_ERROR_HASH, name, "listed in provenance.files, but missing");
        if (sha256(file->second) != hash) refuse_file(CB_ERROR_HASH, name, "not the file that was exported");
        ++listed;
    }
    if (listed != files.size() - 2) refuse_file(CB_ERROR_HASH, config_name, "provenance.files does not list every file");
}

bool same(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

double largest_extent(const Config& c) {
    const Vec3 extent = c.high - c.low;
    return std::max({extent.x, extent.y, extent.z});
}

// As contactbench.pipeline.mesh.probe: a facet has an area. What divides there is a power of two, and rounds nothing.
void check_areas(const ProbeMesh& mesh, const Config& c) {
    double most = 0.0;
    for (const Vec3& p : {c.low, c.high}) most = std::max({most, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    int exponent = 0;
    std::frexp(most, &exponent);
    const double least = std::ldexp(thinnest, exponent);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto at = [&](std::size_t k) { return mesh.vertices[std::size_t(mesh.faces[f][k])]; };
        const Vec3 a = at(1) - at(0), b = at(2) - at(0);
        if (!(norm(cross(a, b)) > least * std::max({norm(a), norm(b), norm(b - a)})))
            refuse_file(CB_ERROR_MESH, c.probe_file, "facet " + std::to_string(f) + " has no area");
    }
}

// Colours of the regions, whose names differ.
std::vector<std::string> colours_of(const Json& regions) {
    std::vector<std::string> colours;
    std::set<std::string_view> names;
    for (const Json& region : regions.items) {
        colours.push_back(region["colour"].text);
        if (!names.insert(region["name"].text).second) refuse("regions", "two have the same name");
    }
    return colours;
}

void check_probe(const ProbeMesh& mesh, const Config& c) {
    Vec3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = -low;
    for (const Triangle& t : mesh.faces)
        for (const std::int32_t i : t) {
            const Vec3& v = mesh.vertices[std::size_t(i)];
            low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
            high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
        }
    if (!same(low, c.low) || !same(high, c.high)) refuse_file(CB_ERROR_MESH, c.probe_file, "not the bounds in probe.bounds_S_m");
    const double size = largest_extent(c);
    if (!(size >= 0.005 && size <= 2.0)) refuse_file(CB_ERROR_MESH, c.probe_file, "no probe is so small or so large");
    std::vector<std::int64_t> counts(c.regions.size() + 1, 0);
    for (const std::int32_t region : mesh.region) ++counts[std::size_t(region)];
    for (std::size_t i = 0; i < c.regions.size(); ++i)
        if (counts[i + 1] != c.regions[i].facets)
            refuse_file(CB_ERROR_MESH, c.probe_file, "not the facets that regions[" + std::to_string(i) + "] counts");
}

// 2 ln(odds) of a touch on each facet.
std::vector<double> bonus_of(const ProbeMesh& mesh, const Config& c) {
    std::vector<double> bonus(mesh.region.size(), 0.0);
    for (std::size_t f = 0; f < bonus.size(); ++f)
        if (mesh.region[f] > 0) bonus[f] = c.regions[std::size_t(mesh.region[f]) - 1].bonus;
    return bonus;
}

// Of each facet, CB_ON_*, as contactbench.pipeline.contact.facet_marks has it.
std::vector<std::uint8_t> marks_of(const ProbeMesh& mesh, const Config& c) {
    std::vector<std::uint8_t> marks(mesh.region.size(), CB_ON_MEASURED);
    for (std::size_t f = 0; f < marks.size(); ++f) {
        if (mesh.invented[f]) marks[f] = CB_ON_INVENTED;
        if (mesh.region[f] > 0 && c.regions[std::size_t(mesh.region[f]) - 1].untouchable) marks[f] = CB_ON_UNTOUCHABLE;
    }
    return marks;
}

// Of a closed surface: positive when its facets face outwards. About the middle of the box, for the digits.
double signed_volume(const ProbeMesh& mesh, const Config& c) {
    const Vec3 middle = 0.5 * (c.low + c.high);
    double six = 0.0;
    for (const Triangle& t : mesh.faces) {
        const auto at = [&](std::size_t k) { return mesh.vertices[std::size_t(t[k])] - middle; };
        six += dot(at(0), cross(at(1), at(2)));
    }
    return six / 6.0;
}

}  // namespace

Bundle load_bundle(const std::string& folder) {
    const Files files = read_folder(folder);
    const std::string& text = files.at(config_name);
    if (files.at(checksum_name) != sha256(text) + "  " + config_name + "\n")
        refuse_file(CB_ERROR_HASH, config_name, std::string("does not have the hash in ") + checksum_name);
    const Json root = parse_json(text);
    const std::string spelled = encode_json(root);
    if (spelled != text)
        refuse_file(CB_ERROR_JSON, config_name,
                    "byte " + std::to_string(first_difference(text, spelled)) + " is not as contactbench writes it");
    Bundle bundle{read_config(text), nullptr, {}};
    check_verified(root);
    check_hashes(files, bundle.config);
    if (bundle.config.self_test != (files.count(self_test_name) ? self_test_name : ""))
        refuse_file(CB_ERROR_VALUE, config_name, "self_test.file is not what the bundle holds");
    ProbeMesh mesh = read_probe(files.at(bundle.config.probe_file), bundle.config, colours_of(root["regions"]));
    check_probe(mesh, bundle.config);
    check_areas(mesh, bundle.config);
    if (bundle.config.planes != mesh.faces.size())
        refuse_file(CB_ERROR_MESH, planes_name, "planes.count is not the number of facets");
    const double size = largest_extent(bundle.config);
    const bool outward = signed_volume(mesh, bundle.config) > flat * size * size * size;
    const std::vector<double> bonus = bonus_of(mesh, bundle.config);
    bundle.marks = marks_of(mesh, bundle.config);
    try {
        bundle.model = std::make_shared<const Model>(make_model(std::move(mesh.vertices), mesh.faces,
                                                                std::move(mesh.region), bonus, bundle.config.mesh));
    } catch (const std::invalid_argument& error) {
        refuse_file(CB_ERROR_MESH, bundle.config.probe_file, error.what());
    }
    if (bundle.config.verified && !(bundle.model->closed && outward))
        refuse_file(CB_ERROR_MESH, bundle.config.probe_file, "a surface that is open or inside out was never verified");
    return bundle;
}

}  // namespace contactbench::runtime

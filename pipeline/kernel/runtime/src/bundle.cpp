#include "bundle.hpp"

#include <algorithm>

#include "folder.hpp"
#include "ply.hpp"
#include "sha256.hpp"
#include "tables.hpp"

namespace contactbench::runtime {

namespace {

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

void check_probe(const ProbeMesh& mesh, const Config& c) {
    if (mesh.faces.size() != c.facets) refuse_file(CB_ERROR_MESH, c.probe_file, "not the number of facets in probe.facets");
    if (mesh.vertices.size() != c.vertices)
        refuse_file(CB_ERROR_MESH, c.probe_file, "not the number of vertices in probe.vertices");
    Vec3 low = mesh.vertices[0], high = low;
    for (const Vec3& v : mesh.vertices) {
        low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
        high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
    if (!same(low, c.low) || !same(high, c.high)) refuse_file(CB_ERROR_MESH, c.probe_file, "not the bounds in probe.bounds_S_m");
    std::vector<std::int64_t> counts(c.regions.size() + 1, 0);
    for (const std::int32_t region : mesh.region) {
        if (std::size_t(region) >= counts.size()) refuse_file(CB_ERROR_MESH, c.probe_file, "a region that regions does not list");
        ++counts[std::size_t(region)];
    }
    for (std::size_t i = 0; i < c.regions.size(); ++i)
        if (counts[i + 1] != c.regions[i].facets)
            refuse_file(CB_ERROR_MESH, c.probe_file, "not the facets that regions[" + std::to_string(i) + "] counts");
    std::string untouchable;
    for (const RegionRow& region : c.regions)
        if (region.untouchable) (untouchable += ' ') += std::to_string(region.rank);
    if (mesh.untouchable != untouchable)
        refuse_file(CB_ERROR_MESH, c.probe_file, "not the untouchable regions that regions lists");
}

// 2 ln(odds) of a touch on each facet.
std::vector<double> bonus_of(const ProbeMesh& mesh, const Config& c) {
    std::vector<double> bonus(mesh.region.size(), 0.0);
    for (std::size_t f = 0; f < bonus.size(); ++f)
        if (mesh.region[f] > 0) bonus[f] = c.regions[std::size_t(mesh.region[f]) - 1].bonus;
    return bonus;
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
    Bundle bundle{read_config(text), nullptr};
    check_hashes(files, bundle.config);
    ProbeMesh mesh = read_probe(files.at(bundle.config.probe_file), bundle.config.probe_file);
    check_probe(mesh, bundle.config);
    check_planes(files.at(planes_name), mesh, bundle.config);
    check_gravity_files(files, bundle.config.settings.gravity);
    const bool outward = signed_volume(mesh, bundle.config) > 0.0;
    const std::vector<double> bonus = bonus_of(mesh, bundle.config);
    try {
        bundle.model = std::make_shared<const Model>(make_model(std::move(mesh.vertices), mesh.faces,
                                                                std::move(mesh.region), bonus, bundle.config.mesh));
    } catch (const std::invalid_argument& error) {
        refuse_file(CB_ERROR_MESH, bundle.config.probe_file, error.what());
    }
    if (bundle.config.verified && !(bundle.model->topology.closed() && outward))
        refuse_file(CB_ERROR_MESH, bundle.config.probe_file, "a surface that is open or inside out was never verified");
    return bundle;
}

}  // namespace contactbench::runtime

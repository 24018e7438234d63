// contactbench.json, checked: every field there is, of its type, in its range, and physically possible.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contactbench/runtime.hpp"
#include "errors.hpp"

namespace contactbench::runtime {

struct RegionRow {
    std::int64_t rank, facets;
};

struct Config {
    RuntimeSettings settings;
    bool verified = false;
    std::string sensor_model, sensor_serial, probe_name, probe_file;
    std::size_t facets = 0, vertices = 0, planes = 0;
    Vec3 low, high;  // bounds of the probe, S, m
    std::vector<RegionRow> regions;
    double rate = 0.0, max_force = 0.0, max_torque = 0.0;
    std::optional<std::array<double, 9>> R_ES;
    std::vector<std::pair<std::string, std::string>> files;  // name, SHA-256
};

// Throws LoadError.
Config read_config(std::string_view json);

}  // namespace contactbench::runtime

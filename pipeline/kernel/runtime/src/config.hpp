// contactbench.json, checked: every field there is, of its type, in its range, and physically possible.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
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
    double bonus;  // 2 ln(odds)
    bool untouchable;
};

struct Config {
    RuntimeSettings settings;
    std::int64_t version = 0;  // as it was written
    bool verified = false;
    std::string doubt;  // why not; empty: it is, or nobody said
    std::string sensor_model, sensor_serial, probe_name, probe_file;
    std::size_t facets = 0, vertices = 0, planes = 0;
    MeshTerms mesh;
    Vec3 low, high;  // bounds of the probe, S, m
    std::vector<RegionRow> regions;
    Vec3 down_W{0.0, 0.0, -1.0};  // a unit vector
    double rate = 0.0;
    bool controlled = false;
    cb_controller controller{};  // the limits, and where it is `controlled` all the rest
    std::optional<std::array<double, 9>> R_ES;
    std::string self_test;  // a file; empty: none
    std::size_t self_test_samples = 0;
    std::vector<std::pair<std::string, std::string>> files;  // name, SHA-256
};

// Of this version or an older one. Throws LoadError.
Config read_config(std::string_view json);

}  // namespace contactbench::runtime

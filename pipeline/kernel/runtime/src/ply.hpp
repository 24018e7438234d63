// The probe's mesh: binary PLY as contactbench writes it, to the byte, and nothing else.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config.hpp"
#include "contactbench/topology.hpp"
#include "contactbench/vec.hpp"

namespace contactbench::runtime {

struct ProbeMesh {
    std::vector<Vec3> vertices;  // S, m
    std::vector<Triangle> faces;
    std::vector<std::int32_t> region;
    std::vector<std::uint8_t> invented;  // 1: the original had no such facet
};

// The mesh that `config` describes; `colours` are those of its regions, like #1f77b4. Nothing is allocated for a count
// before the bytes it claims are seen to be there. Throws LoadError (CB_ERROR_MESH).
ProbeMesh read_probe(std::string_view data, const Config& config, const std::vector<std::string>& colours);

}  // namespace contactbench::runtime

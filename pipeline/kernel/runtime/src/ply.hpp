// The probe's mesh: binary PLY as contactbench writes it, and nothing else.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "contactbench/topology.hpp"
#include "contactbench/vec.hpp"
#include "errors.hpp"

namespace contactbench::runtime {

struct ProbeMesh {
    std::vector<Vec3> vertices;  // S, m
    std::vector<Triangle> faces;
    std::vector<std::int32_t> region;
    std::string untouchable;  // numbers of the regions, as the header lists them: " 2 3"
};

// `name` is for messages. Nothing is allocated for a count before the bytes it claims are seen to be there.
// Throws LoadError (CB_ERROR_MESH).
ProbeMesh read_probe(std::string_view data, const std::string& name);

}  // namespace contactbench::runtime

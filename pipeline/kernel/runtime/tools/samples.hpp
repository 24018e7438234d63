// Samples for the tools: sixteen doubles each, time first, as in a file of `contactbench-locate`, but binary.
#pragma once

#include <cstdio>
#include <vector>

struct Sample {
    double time, wrench[6], R_WS[9];
};

inline std::vector<Sample> read_samples(const char* path) {
    std::vector<Sample> samples;
    std::FILE* file = std::fopen(path, "rb");
    if (!file) return samples;
    Sample s;
    while (std::fread(&s, sizeof s, 1, file) == 1) samples.push_back(s);
    std::fclose(file);
    return samples;
}

// What a test's probe feels, as the Python side computed it: free and touched at the level pose, free at a tilted one.
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "check.hpp"

struct Readings {
    double free[6], touched[6], tilted[6], tilted_xyzw[4];

    explicit Readings(const char* file) {
        std::FILE* in = std::fopen(file, "r");
        double* const numbers[] = {free, touched, tilted, tilted_xyzw};
        const int counts[] = {6, 6, 6, 4};
        for (int part = 0; part < 4; ++part)
            for (int i = 0; i < counts[part]; ++i)
                if (!in || std::fscanf(in, "%lf", numbers[part] + i) != 1) std::exit(2);
        std::fclose(in);
    }
};

inline testing::Random& chance() {
    static testing::Random random(7);
    return random;
}

// A reading with the sensor's noise: one that repeats is a sensor that hangs.
inline void noisy(const double from[6], double to[6]) {
    for (int i = 0; i < 6; ++i) to[i] = from[i] + (i < 3 ? 0.02 : 0.0005) * chance().normal();
}

inline int result() {
    std::printf("%ld checks passed, %ld failed\n", testing::counts().passed, testing::counts().failed);
    return testing::counts().failed == 0 ? 0 : 1;
}

/* anywhere BUNDLE SAMPLES [LOCALE]: is everything the same in a process that has a locale and a floating-point
 * environment of its own? Replays the samples under each rounding, with traps and with small numbers flushed, and fails
 * where a bit of a contact differs, a call ends in a trap, or the caller's environment has changed.
 *
 * C99 and C++11, as a user's own program may be. Prints a hash of all contacts: the same from every build.
 */
#if !defined(_GNU_SOURCE)
#define _GNU_SOURCE /* feenableexcept */
#endif
#include <contactbench_runtime.h>
#include <fenv.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

enum { doubles = 16, most = 20000 };
static double samples[most][doubles]; /* time, wrench, R_WS */
static cb_contact contacts[most], again[most];

/* FNV-1a */
static unsigned long long hash_of(const void* data, size_t size) {
    const unsigned char* byte = (const unsigned char*)data;
    unsigned long long hash = 14695981039346656037ULL;
    while (size-- > 0) hash = (hash ^ *byte++) * 1099511628211ULL;
    return hash;
}

/* NULL, or what went wrong. */
static const char* replay(const char* bundle, int count, cb_contact* out, cb_error* error) {
    const cb_contact fresh = CB_CONTACT_INIT;
    cb_zero zero = CB_ZERO_INIT;
    cb_runtime* runtime = cb_open(bundle, error);
    if (!runtime) return error->message;
    if (cb_selftest(bundle, error) != CB_OK && strstr(error->message, "no test vectors") == NULL) return error->message;
    for (int i = 0; i < count; ++i) {
        out[i] = fresh;
        if (cb_update(runtime, samples[i] + 1, samples[i] + 7, samples[i][0], &out[i]) != CB_OK) return "cb_update failed";
    }
    if (cb_check_zero(runtime, &zero) != CB_OK) return "cb_check_zero failed";
    cb_close(runtime);
    return NULL;
}

static const char* const names[] = {"as it is", "rounding up", "rounding down", "rounding to zero", "traps", "flushing"};

static int set(int which) {
    static const int roundings[] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
    fesetenv(FE_DFL_ENV);
    if (which < 4) return fesetround(roundings[which]) == 0;
#if defined(__GLIBC__)
    if (which == 4) return feenableexcept(FE_ALL_EXCEPT) != -1;
#endif
#if defined(__SSE2__)
    if (which == 5) return _mm_setcsr(_mm_getcsr() | 0x8040), 1;
#endif
    return 0;
}

static unsigned long long environment(void) {
#if defined(__SSE2__)
    return _mm_getcsr();
#else
    return (unsigned long long)fegetround() << 16 | (unsigned long long)fetestexcept(FE_ALL_EXCEPT);
#endif
}

int main(int argc, char** argv) {
    cb_error error = CB_ERROR_INIT;
    FILE* file = argc > 2 ? fopen(argv[2], "rb") : NULL;
    const int count = file ? (int)fread(samples, sizeof samples[0], most, file) : 0;
    if (file) fclose(file);
    if (count < 1 || (argc > 3 && !setlocale(LC_ALL, argv[3]))) {
        fputs("usage: anywhere BUNDLE SAMPLES [LOCALE]; LOCALE has to be installed, \"\" is that of LC_ALL\n", stderr);
        return 2;
    }
    for (int which = 0; which < 6; ++which) {
        if (!set(which)) continue;
        const unsigned long long before = environment();
        const char* wrong = replay(argv[1], count, which ? again : contacts, &error);
        const unsigned long long after = environment();
        fesetenv(FE_DFL_ENV);
        if (!wrong && after != before) wrong = "the caller's environment has changed";
        if (!wrong && which && memcmp(contacts, again, (size_t)count * sizeof contacts[0]) != 0) wrong = "other contacts";
        if (wrong) {
            printf("%s: %s\n", names[which], wrong);
            return 1;
        }
    }
    printf("%016llx\n", hash_of(contacts, (size_t)count * sizeof contacts[0]));
    return 0;
}

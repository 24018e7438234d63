// Counts what the heap is asked for while `counting`. malloc itself is counted, so nothing can go past operator new.
#pragma once

#include <cstdlib>

namespace {
long requests = 0;
bool counting = false;
}  // namespace

// glibc's own names: these definitions stand in front of malloc for the whole process.
extern "C" {
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
void __libc_free(void*);
#define COUNTED __attribute__((visibility("default")))
COUNTED void* malloc(size_t n) { return requests += counting, __libc_malloc(n); }
COUNTED void* calloc(size_t n, size_t size) { return requests += counting, __libc_calloc(n, size); }
COUNTED void* realloc(void* p, size_t n) { return requests += counting, __libc_realloc(p, n); }
COUNTED void* aligned_alloc(size_t to, size_t n) { return requests += counting, __libc_memalign(to, n); }
COUNTED void* memalign(size_t to, size_t n) { return requests += counting, __libc_memalign(to, n); }
COUNTED void free(void* p) { requests += counting && p, __libc_free(p); }
#undef COUNTED
}

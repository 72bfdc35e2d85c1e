// What an engine in C++ offers to the comparison. A box is six floats: the lower and the upper end
// on x, y and z.
#pragma once
#include <cstddef>
#include <cstdint>

struct Pair {
    uint32_t first, second;
};

struct Box {
    float ends[3][2];
};

// The four functions of an engine: made from the first frame's boxes; a frame; the pairs of the
// last one; gone.
#define PEER(name)                                                                  \
    extern "C" void* name##_new(const Box* boxes, size_t count, unsigned threads);  \
    extern "C" void name##_frame(void* peer, const Box* boxes);                     \
    extern "C" const Pair* name##_pairs(void* peer, size_t* count);                 \
    extern "C" void name##_free(void* peer);

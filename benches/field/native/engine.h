// What an engine in C++ offers to the field. A box is six floats: the lower and the upper end on x,
// y and z.
#pragma once
#include <cstddef>
#include <cstdint>

struct Pair {
    uint32_t first, second;
};

struct Box {
    float ends[3][2];
};

// The four functions of an engine: made from the first frame's boxes, to be used in one of its
// ways; a frame, of all bodies if `bodies` is null; the pairs of the last one; gone.
#define ENGINE(name)                                                                                    \
    extern "C" void* name##_new(const Box* boxes, size_t count, uint32_t threads, uint32_t way);        \
    extern "C" void name##_frame(void* engine, const uint32_t* bodies, const Box* boxes, size_t count); \
    extern "C" const Pair* name##_pairs(void* engine, size_t* count);                                   \
    extern "C" void name##_free(void* engine);

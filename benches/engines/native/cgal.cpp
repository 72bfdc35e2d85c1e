// CGAL's box_self_intersection_d: streamed segment trees (Zomorodian & Edelsbrunner), from nothing each frame.
#include <CGAL/box_intersection_d.h>

#include <vector>

#include "peer.h"
PEER(cgal)

namespace {

using Numbered = CGAL::Box_intersection_d::Box_with_info_d<float, 3, uint32_t>;

struct Cgal {
    size_t count;
    std::vector<Numbered> boxes;
    std::vector<Pair> pairs;
};

}  // namespace

void* cgal_new(const Box*, size_t count, unsigned) { return new Cgal{count, {}, {}}; }

void cgal_frame(void* user, const Box* boxes) {
    Cgal& peer = *static_cast<Cgal*>(user);
    peer.boxes.clear();
    peer.pairs.clear();
    for (size_t i = 0; i < peer.count; i++) {
        float lower[3], upper[3];
        for (int axis = 0; axis < 3; axis++) {
            lower[axis] = boxes[i].ends[axis][0];
            upper[axis] = boxes[i].ends[axis][1];
        }
        peer.boxes.emplace_back(lower, upper, static_cast<uint32_t>(i));
    }
    CGAL::box_self_intersection_d(peer.boxes.begin(), peer.boxes.end(), [&peer](const Numbered& a, const Numbered& b) {
        peer.pairs.push_back({a.info(), b.info()});
    });
}

const Pair* cgal_pairs(void* user, size_t* count) {
    const Cgal& peer = *static_cast<Cgal*>(user);
    *count = peer.pairs.size();
    return peer.pairs.data();
}

void cgal_free(void* user) { delete static_cast<Cgal*>(user); }

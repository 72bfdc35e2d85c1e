// Bullet's btDbvtBroadphase: two trees that are updated body by body, and a cache of pairs. No
// velocity prediction.
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include <memory>
#include <vector>

#include "engine.h"
ENGINE(bullet)

namespace {

// Without a margin, the tree is tested against itself once per frame, which is faster if all bodies
// move, or once per moved body; the whole cache is cleaned up, so that it holds only the present
// pairs. By default there is a margin, and a tenth of the pairs are looked through in each frame.
enum Way : uint32_t { AT_ONCE, ONE_BY_ONE, BY_DEFAULT };

struct Bullet {
    btHashedOverlappingPairCache cache;
    btDbvtBroadphase broad_phase{&cache};
    float margin;
    std::vector<btBroadphaseProxy*> proxies;
    std::vector<Pair> pairs;
};

btVector3 corner(const Box& box, int side) {
    return btVector3(box.ends[0][side], box.ends[1][side], box.ends[2][side]);
}

}  // namespace

void* bullet_new(const Box* boxes, size_t count, uint32_t, uint32_t way) {
    auto engine = std::make_unique<Bullet>();
    engine->broad_phase.setVelocityPrediction(0);
    engine->broad_phase.m_deferedcollide = way == AT_ONCE;
    engine->broad_phase.m_cupdates = way == BY_DEFAULT ? 10 : 100;
    engine->margin = gDbvtMargin = way == BY_DEFAULT ? 0.05f : 0;
    for (size_t i = 0; i < count; i++) {
        void* number = reinterpret_cast<void*>(i);
        engine->proxies.push_back(
            engine->broad_phase.createProxy(corner(boxes[i], 0), corner(boxes[i], 1), 0, number, 1, 1, nullptr));
    }
    return engine.release();
}

void bullet_frame(void* user, const uint32_t* bodies, const Box* boxes, size_t count) {
    Bullet& engine = *static_cast<Bullet*>(user);
    gDbvtMargin = engine.margin;
    for (size_t i = 0; i < count; i++) {
        btBroadphaseProxy* proxy = engine.proxies[bodies ? bodies[i] : i];
        engine.broad_phase.setAabb(proxy, corner(boxes[i], 0), corner(boxes[i], 1), nullptr);
    }
    engine.broad_phase.calculateOverlappingPairs(nullptr);
}

const Pair* bullet_pairs(void* user, size_t* count) {
    Bullet& engine = *static_cast<Bullet*>(user);
    const btBroadphasePairArray& cached = engine.cache.getOverlappingPairArray();
    engine.pairs.clear();
    for (int at = 0; at < cached.size(); at++) {
        const auto number = [](const btBroadphaseProxy* proxy) {
            return static_cast<uint32_t>(reinterpret_cast<size_t>(proxy->m_clientObject));
        };
        engine.pairs.push_back({number(cached[at].m_pProxy0), number(cached[at].m_pProxy1)});
    }
    *count = engine.pairs.size();
    return engine.pairs.data();
}

void bullet_free(void* user) {
    Bullet* engine = static_cast<Bullet*>(user);
    for (btBroadphaseProxy* proxy : engine->proxies) engine->broad_phase.destroyProxy(proxy, nullptr);
    delete engine;
}

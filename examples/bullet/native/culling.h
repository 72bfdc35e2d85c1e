// S-DOP culling for Bullet: what an application copies, together with sdop.h.
#pragma once
#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "sdop.h"

// Hands over to the narrow phase only pairs that may touch. A collision object is tested if
// its user index 3 is its mesh's number (`setUserIndex3`); pairs with other objects pass.
class CullingDispatcher : public btCollisionDispatcher {
public:
    CullingDispatcher(btCollisionConfiguration* configuration, const SdopPairTest* test)
        : btCollisionDispatcher(configuration), test(test) {
        setNearCallback([](btBroadphasePair& pair, btCollisionDispatcher& dispatcher, const btDispatcherInfo& info) {
            if (static_cast<const CullingDispatcher&>(dispatcher).mayTouch(pair)) defaultNearCallback(pair, dispatcher, info);
        });
    }

    // False only if Bullet's narrow phase would leave the pair without contact points.
    bool mayTouch(const btBroadphasePair& pair) const {
        const auto object = [](const btBroadphaseProxy* proxy) {
            return static_cast<const btCollisionObject*>(proxy->m_clientObject);
        };
        const btCollisionObject *a = object(pair.m_pProxy0), *b = object(pair.m_pProxy1);
        const int first = a->getUserIndex3(), second = b->getUserIndex3();
        if (first < 0 || second < 0 || holdsPoints(pair) || far(a) || far(b)) return true;
        const btTransform between = a->getWorldTransform().inverseTimes(b->getWorldTransform());
        const btQuaternion turn = between.getRotation();
        const btVector3 way = between.getOrigin();
        const float rotation[4] = {turn.x(), turn.y(), turn.z(), turn.w()};
        const float translation[3] = {way.x(), way.y(), way.z()};
        return sdop_pair_test_may_touch(test, uint32_t(first) + 1, uint32_t(second), &rotation, &translation);
    }

    // Adds a mesh about its body's origin, and after it the same grown by `margin`. Returns the
    // first's number, for `setUserIndex3`, or −1 for a mesh that can't be culled: `sdop_last_error`
    // says why, and its bodies pass unfiltered.
    static int add(SdopPairTest* test, const float (*vertices)[3], size_t vertex_count, const uint32_t (*triangles)[3],
                   size_t triangle_count, float margin) {
        std::vector<std::array<double, 3>> wide(vertex_count);
        for (size_t i = 0; i < vertex_count; i++) std::copy(vertices[i], vertices[i] + 3, wide[i].begin());
        const auto corners = reinterpret_cast<const double(*)[3]>(wide.data());
        SdopShape* shape = nullptr;
        uint32_t number = 0, grown = 0;
        const bool added = sdop_shape_new(corners, vertex_count, triangles, triangle_count, nullptr, &shape) == SDOP_STATUS_OK &&
                           sdop_pair_test_add(test, shape, &number) == SDOP_STATUS_OK &&
                           sdop_pair_test_grow(test, number, margin, &grown) == SDOP_STATUS_OK;
        sdop_shape_free(shape);
        return added ? int(number) : -1;
    }

    // What a shape's mesh must be grown by: contacts are made up to both shapes' collision margins
    // (`widest_margin` is the largest in the world) and the smaller of their breaking thresholds. 1
    // % is for GJK, which stops early, and the last term for what rounding moves within `FAR` of
    // the origin.
    static float margin(const btCollisionShape& shape, float widest_margin) {
        const float breaking = shape.getContactBreakingThreshold(gContactBreakingThreshold);
        return 1.01f * (shape.getMargin() + widest_margin + breaking) + std::ldexp(FAR, -17);
    }

    static constexpr float FAR = 256;

private:
    // Points of earlier steps are for Bullet to refresh or to drop.
    static bool holdsPoints(const btBroadphasePair& pair) {
        if (!pair.m_algorithm) return false;
        btManifoldArray manifolds;
        pair.m_algorithm->getAllContactManifolds(manifolds);
        for (int i = 0; i < manifolds.size(); i++) {
            if (manifolds[i]->getNumContacts() > 0) return true;
        }
        return false;
    }

    static bool far(const btCollisionObject* object) {
        const btVector3 place = object->getWorldTransform().getOrigin().absolute();
        return !(place[place.maxAxis()] < FAR);
    }

    const SdopPairTest* test;
};

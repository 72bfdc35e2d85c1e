// Contacts stay what they were: two worlds side by side, in one of which the filter rejects pairs.
// The first is stepped; the second takes over its poses before each step and finds its contacts at
// the same moment. They must be equal to the bit (exit code 0). `--without-margin` plants a bug.
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletDynamicsCommon.h>

#include <cstdio>
#include <cstring>
#include <map>
#include <memory>

#include "culling.h"

namespace {

using Contacts = std::map<std::pair<int, int>, std::vector<float>>;

const int BODIES = 64, STEPS = 200;

// A ring, of this half height.
struct Mesh {
    std::vector<std::array<float, 3>> vertices;
    std::vector<std::array<uint32_t, 3>> triangles;

    explicit Mesh(float height) {
        const uint32_t segments = 12, sides = 6;
        for (uint32_t i = 0; i < segments; i++) {
            for (uint32_t j = 0; j < sides; j++) {
                const float u = SIMD_2_PI * i / segments, v = SIMD_2_PI * j / sides, far = 0.35f + 0.15f * std::cos(v);
                vertices.push_back({far * std::cos(u), height * std::sin(v), far * std::sin(u)});
                const uint32_t a = i * sides + j, b = i * sides + (j + 1) % sides;
                const uint32_t c = (a + sides) % (segments * sides), d = (b + sides) % (segments * sides);
                triangles.push_back({a, b, c});
                triangles.push_back({b, d, c});
            }
        }
    }
};

struct World {
    btDefaultCollisionConfiguration configuration;
    SdopPairTest* test = nullptr;
    std::unique_ptr<CullingDispatcher> dispatcher;
    btDbvtBroadphase broad_phase;
    btSequentialImpulseConstraintSolver solver;
    std::unique_ptr<btDiscreteDynamicsWorld> world;
    std::vector<std::unique_ptr<btTriangleIndexVertexArray>> arrays;
    std::vector<std::unique_ptr<btCollisionShape>> shapes;
    std::vector<std::unique_ptr<btRigidBody>> bodies;

    // Unfiltered bodies have no number, so that both worlds have the same dispatcher.
    World(std::vector<Mesh>& meshes, bool is_mesh, bool is_filtered, float share) {
        sdop_pair_test_new(0, &test);
        dispatcher = std::make_unique<CullingDispatcher>(&configuration, test);
        btGImpactCollisionAlgorithm::registerAlgorithm(dispatcher.get());
        world = std::make_unique<btDiscreteDynamicsWorld>(dispatcher.get(), &broad_phase, &solver, &configuration);
        world->getDispatchInfo().m_useContinuous = false;  // boxes are those of poses
        std::vector<int> numbers;
        for (Mesh& mesh : meshes) {
            shapes.push_back(is_mesh ? surface(mesh) : hull(mesh));
            const float margin = CullingDispatcher::margin(*shapes.back(), CONVEX_DISTANCE_MARGIN) * share;
            const auto vertices = reinterpret_cast<const float(*)[3]>(mesh.vertices.data());
            const auto triangles = reinterpret_cast<const uint32_t(*)[3]>(mesh.triangles.data());
            numbers.push_back(CullingDispatcher::add(test, vertices, mesh.vertices.size(), triangles, mesh.triangles.size(), margin));
        }
        for (int i = 0; i < BODIES; i++) {
            const btVector3 cell(i % 4 - 1.5f, i / 16 - 1.5f, i / 4 % 4 - 1.5f);
            const btQuaternion turn(btVector3(1, 0.3f * i, 0.7f).normalized(), float(i));
            btRigidBody& body = add(1, shapes[i % meshes.size()].get(), btTransform(turn, cell * 1.25f));
            body.setLinearVelocity(btVector3(cell.z(), -3, -cell.x()));
            body.setActivationState(DISABLE_DEACTIVATION);
            if (is_filtered) body.setUserIndex3(numbers[i % meshes.size()]);
        }
        for (const btVector3& normal : {btVector3(0, 1, 0), btVector3(1, 0, 0), btVector3(-1, 0, 0), btVector3(0, 0, 1), btVector3(0, 0, -1)}) {
            shapes.push_back(std::make_unique<btStaticPlaneShape>(normal, -2.7f));
            add(0, shapes.back().get(), btTransform::getIdentity());
        }
    }

    ~World() {
        for (auto& body : bodies) world->removeRigidBody(body.get());
        world.reset();
        dispatcher.reset();
        sdop_pair_test_free(test);
    }

    std::unique_ptr<btCollisionShape> surface(Mesh& mesh) {
        arrays.push_back(std::make_unique<btTriangleIndexVertexArray>(int(mesh.triangles.size()), reinterpret_cast<int*>(mesh.triangles.data()),
                                                                      12, int(mesh.vertices.size()), mesh.vertices[0].data(), 12));
        auto shape = std::make_unique<btGImpactMeshShape>(arrays.back().get());
        shape->setMargin(CONVEX_DISTANCE_MARGIN);
        shape->updateBound();
        return shape;
    }

    static std::unique_ptr<btCollisionShape> hull(const Mesh& mesh) {
        return std::make_unique<btConvexHullShape>(mesh.vertices[0].data(), int(mesh.vertices.size()), 12);
    }

    btRigidBody& add(float mass, btCollisionShape* shape, const btTransform& pose) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape->calculateLocalInertia(mass, inertia);
        bodies.push_back(std::make_unique<btRigidBody>(mass, nullptr, shape, inertia));
        bodies.back()->setWorldTransform(pose);
        bodies.back()->setUserIndex(int(bodies.size()) - 1);
        world->addRigidBody(bodies.back().get());
        return *bodies.back();
    }

    // The touching pairs, with the distance of each contact point.
    Contacts contacts() const {
        Contacts found;
        for (int i = 0; i < dispatcher->getNumManifolds(); i++) {
            const btPersistentManifold* manifold = dispatcher->getManifoldByIndexInternal(i);
            const int a = manifold->getBody0()->getUserIndex(), b = manifold->getBody1()->getUserIndex();
            for (int k = 0; k < manifold->getNumContacts(); k++) {
                found[std::minmax(a, b)].push_back(manifold->getContactPoint(k).getDistance());
            }
        }
        return found;
    }
};

}  // namespace

int main(int count, char** arguments) {
    const float share = count > 1 && !std::strcmp(arguments[1], "--without-margin") ? 0 : 1;
    bool fails = false;
    for (const bool is_mesh : {false, true}) {
        std::vector<Mesh> meshes{Mesh(0.15f), Mesh(0.05f)};
        World whole(meshes, is_mesh, false, share), filtered(meshes, is_mesh, true, share);
        size_t touching = 0, rejected = 0, differ = 0;
        for (int step = 0; step < STEPS; step++) {
            for (size_t i = 0; i < filtered.bodies.size(); i++) filtered.bodies[i]->setWorldTransform(whole.bodies[i]->getWorldTransform());
            filtered.world->performDiscreteCollisionDetection();
            whole.world->stepSimulation(1 / 60.f, 0);
            differ += filtered.contacts() != whole.contacts();
            touching += whole.contacts().size();
            const btBroadphasePairArray& pairs = filtered.broad_phase.getOverlappingPairCache()->getOverlappingPairArray();
            for (int i = 0; i < pairs.size(); i++) rejected += !filtered.dispatcher->mayTouch(pairs[i]);
        }
        std::printf("%s: %zu touching pairs, %zu rejected; %zu of %d steps differ\n", is_mesh ? "meshes" : "hulls", touching, rejected, differ, STEPS);
        fails |= differ > 0 || touching == 0 || rejected == 0;
    }
    return fails;
}

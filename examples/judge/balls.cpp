// A culler of bounding balls in f32, judged with
//
//     c++ -O2 -std=c++17 -o balls examples/judge/balls.cpp
//     sdop judge ./balls --wire text --claims sphere
//     sdop bench data/scenes/paper-500.toml --exec ./balls --wire text --claims sphere
//
// Compiled with -DNO_MARGIN, it compares without room for its own rounding.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

static std::string word() { char w[4096]; return std::scanf("%4095s", w) == 1 ? w : ""; }
static int count() { return std::atoi(word().c_str()); }
static float real() {
    unsigned bits = 0;
    float x;
    if (std::scanf("%8x", &bits) != 1) std::exit(2);
    std::memcpy(&x, &bits, sizeof x);
    return x;
}
static void skip(int words) { while (words-- > 0) word(); }

// --- the culler --------------------------------------------------------------------------------
struct Ball { float x[3], r, size; }; // size: the largest number that went into it
struct Body { int shape; bool fixed; };

static Ball posed(const Ball &b, const float q[4], const float t[3]) {
    float s = std::max({std::fabs(q[0]), std::fabs(q[1]), std::fabs(q[2]), std::fabs(q[3])});
    float v[3] = {q[0] / s, q[1] / s, q[2] / s}, w = q[3] / s;
    float n = 2 / (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + w * w);
    auto cross = [&](const float c[3], int k) { return v[(k + 1) % 3] * c[(k + 2) % 3] - v[(k + 2) % 3] * c[(k + 1) % 3]; };
    float u[3] = {cross(b.x, 0), cross(b.x, 1), cross(b.x, 2)}; // c + n (w u + v × u), u = v × c
    Ball p{{}, b.r, b.r};
    for (int k = 0; k < 3; k++) {
        p.x[k] = t[k] + (b.x[k] + n * (w * u[k] + cross(u, k)));
        p.size = std::max({p.size, std::fabs(t[k]), std::fabs(b.x[k])}); // they may cancel in x
    }
    return p;
}

static bool meet(const Ball &a, const Ball &b) {
    float reach = a.r + b.r;
#ifndef NO_MARGIN
    reach += 1.2e-5f * std::max(a.size, b.size) + 1e-37f;
#endif
    return std::hypot(a.x[0] - b.x[0], a.x[1] - b.x[1], a.x[2] - b.x[2]) <= reach;
}

int main() {
    std::vector<Ball> shapes, balls;
    std::vector<Body> bodies;
    for (std::string w = word(); !w.empty(); w = word()) {
        if (w == "shapes") {
            for (int n = count(); n > 0; n--) {
                skip(2); // shape NAME
                int vertices = count(), triangles = count(), slabs = count();
                skip(1); // ball
                Ball ball{};
                for (float &x : ball.x) x = real();
                ball.r = real();
                shapes.push_back(ball);
                skip(10 + 2 * (1 + slabs) + 4 * (vertices + triangles));
            }
        } else if (w == "bodies" || w == "change") {
            bodies.resize(count());
            for (Body &body : bodies) {
                body.shape = count();
                body.fixed = count() == 1;
                if (w == "change") skip(1); // its former number
            }
        } else if (w == "frame") {
            int frame = count(), n = count();
            balls.resize(n);
            std::vector<float> poses(7 * n); // q, then t
            for (int i = 0; i < 7 * n; poses[i++] = real()) skip(i % 7 == 0); // p
            auto start = std::chrono::steady_clock::now();
            for (int i = 0; i < n; i++) balls[i] = posed(shapes[bodies[i].shape], &poses[7 * i], &poses[7 * i + 4]);
            std::vector<int> pairs;
            long tests = 0; // nv; nu, the updates, are all bodies
            for (int j = 0; j < n; j++)
                for (int i = 0; i < j; i++)
                    if (!(bodies[i].fixed && bodies[j].fixed) && ++tests && meet(balls[i], balls[j])) pairs.insert(pairs.end(), {i, j});
            long ns = (std::chrono::steady_clock::now() - start) / std::chrono::nanoseconds(1);
            std::printf("frame %d %zu", frame, pairs.size() / 2);
            for (int id : pairs) std::printf(" %d", id);
            std::printf(" ns %ld nu %d nv %ld\n", ns, n, tests);
        }
    }
}

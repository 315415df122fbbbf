/// Tangents against what their definition says of simple surfaces, and of meshes that are hardly any.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>

#include "scenes/data/tangent_space.h"
#include "tests/host_speed.h"

using namespace quadrille::scenes;

namespace {

std::uint32_t add(TangentMesh& mesh, const glm::vec3& position, const glm::vec3& normal,
                  const glm::vec2& uv) {
  mesh.positions.push_back(position);
  mesh.normals.push_back(normal);
  mesh.uvs.push_back(uv);
  return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

/// Calls `point(i / columns, j / rows)`, which adds a vertex, for a grid of two triangles a cell.
template <class Point>
TangentMesh grid(std::uint32_t columns, std::uint32_t rows, const Point& point) {
  TangentMesh mesh;
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i <= columns; ++i)
      point(mesh, static_cast<float>(i) / static_cast<float>(columns),
            static_cast<float>(j) / static_cast<float>(rows));
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = j * (columns + 1) + i, b = a + columns + 1;
      for (const std::uint32_t v : {a, b, a + 1, a + 1, b, b + 1}) mesh.corners.push_back(v);
    }
  }
  return mesh;
}

/// x to the right as u, y up as v goes down: what a picture on a wall is.
TangentMesh wall(std::uint32_t cells) {
  return grid(cells, cells, [](TangentMesh& mesh, float u, float v) {
    add(mesh, {u, 1 - v, 0}, {0, 0, 1}, {u, v});
  });
}

bool same(const glm::vec4& a, const glm::vec4& b) {
  using Bits = std::array<std::uint32_t, 4>;
  return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

}  // namespace

TEST_CASE("tangent space: on a plane they are where u grows, and the bitangent points to lesser v") {
  for (const glm::vec4& tangent : tangents_of(wall(4))) REQUIRE(same(tangent, {1, 0, 0, 1}));
  TangentMesh turned = wall(4);
  for (glm::vec2& uv : turned.uvs) uv = {3 * uv.y, 1 - 0.5F * uv.x};  // u grows downward, v to the left
  for (const glm::vec4& tangent : tangents_of(turned)) REQUIRE(same(tangent, {0, -1, 0, 1}));
  TangentMesh mirrored = wall(4);
  for (glm::vec2& uv : mirrored.uvs) uv.x = 1 - uv.x;
  for (const glm::vec4& tangent : tangents_of(mirrored)) REQUIRE(same(tangent, {-1, 0, 0, -1}));
}

TEST_CASE("tangent space: coordinates that are sheared give the direction of u, not that across v") {
  TangentMesh sheared = wall(2);
  for (glm::vec2& uv : sheared.uvs) uv.y += uv.x;  // v also grows with x: along constant v both x and y grow
  for (const glm::vec4& tangent : tangents_of(sheared)) {
    CHECK(tangent.x == Approx(std::numbers::sqrt2 / 2));
    CHECK(tangent.y == Approx(std::numbers::sqrt2 / 2));
    CHECK(tangent.w == 1);
  }
}

TEST_CASE("tangent space: at a seam of mirrored coordinates a vertex has a tangent a side") {
  TangentMesh mesh = wall(4);
  for (glm::vec2& uv : mesh.uvs) uv.x = std::fabs(uv.x - 0.5F);
  const std::vector<glm::vec4> tangents = tangents_of(mesh);
  for (std::size_t c = 0; c < tangents.size(); ++c) {
    const std::size_t t = c - c % 3;
    float middle = 0;
    for (std::size_t k = 0; k < 3; ++k) middle += mesh.positions[mesh.corners[t + k]].x / 3;
    REQUIRE(same(tangents[c], middle > 0.5F ? glm::vec4(1, 0, 0, 1) : glm::vec4(-1, 0, 0, -1)));
  }
}

TEST_CASE("tangent space: around a cylinder they go round, whether its vertices are shared or not") {
  const auto ring = [](TangentMesh& mesh, float u, float v) {
    // the last column's vertices lie exactly on the first one's, but for u
    const float angle = 2 * std::numbers::pi_v<float> * (u < 1 ? u : 0);
    const glm::vec3 out(std::sin(angle), 0, std::cos(angle));
    add(mesh, {out.x, 1 - v, out.z}, out, {u, v});
  };
  const TangentMesh shared = grid(32, 4, ring);
  TangentMesh apart;
  for (const std::uint32_t v : shared.corners) {
    apart.corners.push_back(add(apart, shared.positions[v], shared.normals[v], shared.uvs[v]));
  }
  const std::vector<glm::vec4> tangents = tangents_of(shared), others = tangents_of(apart);
  for (std::size_t c = 0; c < tangents.size(); ++c) {
    const glm::vec3 n = shared.normals[shared.corners[c]];
    // inside the seam by symmetry; at the seam the group has triangles on one side only, half a cell off
    const bool seam = shared.uvs[shared.corners[c]].x == 0 || shared.uvs[shared.corners[c]].x == 1;
    const glm::vec3 round(n.z, 0, -n.x);
    CHECK(glm::dot(glm::vec3(tangents[c]), round) > (seam ? 0.99F : 0.99999F));
    CHECK(tangents[c].w == 1);
    REQUIRE(same(tangents[c], others[c]));
  }
}

TEST_CASE("tangent space: they are of unit length, across the normal, and follow u on a sphere") {
  const TangentMesh mesh = grid(64, 32, [](TangentMesh& m, float u, float v) {
    const float around = 2 * std::numbers::pi_v<float> * u,
                down = std::numbers::pi_v<float> * (0.05F + 0.9F * v);
    const glm::vec3 out(std::sin(down) * std::sin(around), std::cos(down), std::sin(down) * std::cos(around));
    add(m, out, out, {u, v});
  });
  const std::vector<glm::vec4> tangents = tangents_of(mesh);
  for (std::size_t c = 0; c < tangents.size(); ++c) {
    const glm::vec3 n = mesh.normals[mesh.corners[c]], t(tangents[c]);
    const glm::vec3 round = glm::normalize(glm::vec3(n.z, 0, -n.x));
    CHECK(std::fabs(glm::length(t) - 1) < 1e-6F);
    CHECK(std::fabs(glm::dot(t, n)) < 1e-6F);
    CHECK(glm::dot(t, round) > 0.995F);
    CHECK(tangents[c].w == 1);
  }
}

TEST_CASE("tangent space: shares are weighted by the angle at the vertex") {
  // Around the origin a quarter turn with u along x, and an eighth with u along the diagonal.
  TangentMesh mesh;
  const glm::vec3 up(0, 0, 1);
  const std::uint32_t o = add(mesh, {0, 0, 0}, up, {0, 0}), x = add(mesh, {1, 0, 0}, up, {1, 0}),
                      y = add(mesh, {0, 1, 0}, up, {0, -1});
  // across the edge o-y, whose coordinates stay (0,0) and (0,-1), the third corner lies at (-1,1)
  const std::uint32_t z = add(mesh, {-1, 1, 0}, up, {-1, -3});
  mesh.corners = {o, x, y, o, y, z};
  const std::vector<glm::vec4> tangents = tangents_of(mesh);
  // second triangle: (0,1,0) = -e_v and (-1,1,0) = -e_u - 3 e_v, so e_u = (1,-1,0) + 3 (0,1,0) = (1,2,0)
  const glm::dvec3 first(1, 0, 0), second = glm::normalize(glm::dvec3(1, 2, 0));
  const glm::dvec3 sum = glm::normalize(2.0 * first + 1.0 * second);
  CHECK(glm::distance(glm::dvec3(tangents[0]), sum) < 1e-7);
  CHECK(same(tangents[0], tangents[3]));
  CHECK(same(tangents[1], {1, 0, 0, 1}));
  CHECK(glm::distance(glm::dvec3(tangents[5]), second) < 1e-7);
}

TEST_CASE("tangent space: triangles that meet in a vertex alone are groups of their own") {
  TangentMesh mesh;
  const glm::vec3 up(0, 0, 1);
  const std::uint32_t o = add(mesh, {0, 0, 0}, up, {0, 0});
  // u along x on the right, along the diagonal on the left; both wind alike
  mesh.corners = {o, add(mesh, {1, -1, 0}, up, {1, 1}),  add(mesh, {1, 1, 0}, up, {1, -1}),
                  o, add(mesh, {-1, 1, 0}, up, {-1, 0}), add(mesh, {-1, -1, 0}, up, {0, 1})};
  const std::vector<glm::vec4> tangents = tangents_of(mesh);
  CHECK(same(tangents[0], {1, 0, 0, 1}));
  CHECK(tangents[3].x == Approx(std::numbers::sqrt2 / 2));
  CHECK(tangents[3].y == Approx(-std::numbers::sqrt2 / 2));
}

TEST_CASE("tangent space: a triangle without area of coordinates joins its neighbours' groups") {
  TangentMesh mesh = wall(2);
  const std::uint32_t corner = mesh.corners[0];                                     // only this triangle's
  mesh.uvs[corner] = 2.0F * mesh.uvs[mesh.corners[1]] - mesh.uvs[mesh.corners[2]];  // all on one line
  const std::vector<glm::vec4> tangents = tangents_of(mesh);
  CHECK(same(tangents[1], {1, 0, 0, 1}));
  CHECK(same(tangents[2], {1, 0, 0, 1}));
  CHECK(same(tangents[0], {1, 0, 0, 1}));  // by the written rule: nobody else is at that corner
}

TEST_CASE("tangent space: a triangle with two corners in one place takes what others have there") {
  TangentMesh mesh = wall(2);
  for (glm::vec2& uv : mesh.uvs) uv = {uv.y, -uv.x};  // tangents point down
  const auto count = static_cast<std::uint32_t>(mesh.corners.size());
  const std::uint32_t alone = add(mesh, {9, 9, 9}, {1, 0, 0}, {0, 0});
  for (const std::uint32_t v : {0U, 0U, 1U, alone, 4U, alone}) mesh.corners.push_back(v);
  const std::vector<glm::vec4> tangents = tangents_of(mesh);
  for (const std::uint32_t c : {0U, 1U, 2U, 4U}) CHECK(same(tangents[count + c], {0, -1, 0, 1}));
  CHECK(same(tangents[count + 3], {0, 1, 0, 1}));  // y: its normal is along x
}

TEST_CASE("tangent space: without any coordinates they are x in the plane of the normal, or y") {
  TangentMesh mesh = wall(1);
  for (glm::vec2& uv : mesh.uvs) uv = {0.25F, 0.75F};
  for (const glm::vec4& tangent : tangents_of(mesh)) CHECK(same(tangent, {1, 0, 0, 1}));
  for (glm::vec3& normal : mesh.normals) normal = {-2, 0, 0};
  for (const glm::vec4& tangent : tangents_of(mesh)) CHECK(same(tangent, {0, 1, 0, 1}));
  for (glm::vec3& normal : mesh.normals) normal = {0, 0, 0};
  for (const glm::vec4& tangent : tangents_of(mesh)) CHECK(same(tangent, {1, 0, 0, 1}));
}

TEST_CASE("tangent space: the order of triangles is of no account, bit by bit") {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> noise(-0.02F, 0.02F);
  TangentMesh mesh = grid(20, 20, [&](TangentMesh& m, float u, float v) {
    add(m, {u + noise(random), 1 - v + noise(random), noise(random)}, {noise(random), noise(random), 1},
        {std::fabs(u - 0.5F) + noise(random) / 4, v + noise(random)});
  });
  const std::vector<glm::vec4> tangents = tangents_of(mesh);
  std::vector<std::size_t> order(mesh.corners.size() / 3);
  for (std::size_t t = 0; t < order.size(); ++t) order[t] = t;
  std::ranges::shuffle(order, random);
  TangentMesh shuffled = mesh;
  for (std::size_t t = 0; t < order.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) shuffled.corners[3 * t + k] = mesh.corners[3 * order[t] + k];
  const std::vector<glm::vec4> again = tangents_of(shuffled);
  for (std::size_t t = 0; t < order.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) REQUIRE(same(again[3 * t + k], tangents[3 * order[t] + k]));
}

TEST_CASE("tangent space: many triangles around one vertex, and on one edge") {
  TangentMesh fan;
  const glm::vec3 up(0, 0, 1);
  add(fan, {0, 0, 0}, up, {0, 0});
  constexpr std::uint32_t kBlades = 20000;
  for (std::uint32_t i = 0; i < kBlades; ++i) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kBlades;
    add(fan, {std::cos(angle), std::sin(angle), 0}, up, {std::cos(angle), -std::sin(angle)});
    for (const std::uint32_t v : {0U, 1 + i, 1 + (i + 1) % kBlades}) fan.corners.push_back(v);
  }
  for (const glm::vec4& tangent : tangents_of(fan)) {
    REQUIRE(tangent.x > 0.99999F);
    REQUIRE(tangent.w == 1);
  }
  TangentMesh book;  // leaves on one spine, each seen from either side
  add(book, {0, 0, 0}, up, {0, 0});
  add(book, {0, 1, 0}, up, {0, -1});
  for (std::uint32_t i = 0; i < kBlades; ++i) {
    add(book, {1, 0, static_cast<float>(i)}, up, {1, 0});
    for (const std::uint32_t v : {0U, 2 + i, 1U, 1U, 2 + i, 0U}) book.corners.push_back(v);
  }
  REQUIRE(tangents_of(book).size() == book.corners.size());
}

TEST_CASE("tangent space: whatever the values, tangents are finite, of unit length, and have a sign") {
  std::mt19937 random(7);
  const float inf = std::numeric_limits<float>::infinity();
  const std::array<float, 12> odd{
      0,   -0.0F, 1, -1, 1e-30F, 1e-42F, 3e38F, -3e38F, inf, -inf, std::numeric_limits<float>::quiet_NaN(),
      0.5F};
  const auto value = [&] { return odd[random() % odd.size()]; };
  for (int round = 0; round < 300; ++round) {
    TangentMesh mesh;
    for (int v = 0; v < 12; ++v)
      add(mesh, {value(), value(), value()}, {value(), value(), value()}, {value(), value()});
    for (int c = 0; c < 60; ++c) mesh.corners.push_back(static_cast<std::uint32_t>(random() % 12));
    for (const glm::vec4& tangent : tangents_of(mesh)) {
      REQUIRE(std::fabs(glm::length(glm::vec3(tangent)) - 1) < 1e-5F);
      REQUIRE(std::fabs(tangent.w) == 1);
    }
  }
  REQUIRE(tangents_of({}).empty());
}

TEST_CASE("tangent space: what the reference implementation gives for a mesh with a mirrored half") {
  TangentMesh mesh = grid(2, 2, [](TangentMesh& m, float u, float v) {
    const int x = static_cast<int>(2 * u), y = static_cast<int>(2 * v);
    const auto f = [](int numerator, float denominator) {
      return static_cast<float>(numerator) / denominator;
    };
    add(m,
        {f(10 * x + (7 * x + 3 * y) % 5, 10), f(14 * y + (3 * x + 5 * y) % 7, 14), f((3 * x * y + x) % 4, 8)},
        {f((x + 2 * y) % 3 - 1, 4), f((2 * x + y) % 3 - 1, 4), 1},
        {f(8 * std::abs(x - 1) + (5 * x + y) % 3, 16), f(16 * y + (x + 4 * y) % 5, 32)});
  });
  for (std::size_t c = 0; c < mesh.corners.size(); c += 6)  // its cells are cut and wound the other way
    for (const auto& [to, from] : {std::pair<std::size_t, std::size_t>{1, 2}, {4, 5}})
      std::swap(mesh.corners[c + to], mesh.corners[c + from]);
  // [M: mikktspace 1.1.1], w turned over
  const std::array<glm::vec4, 24> wanted{{
      {-0.961479F, -0.084629F, -0.261527F, 1}, {-0.999003F, -0.043301F, 0.010825F, 1},
      {-0.969423F, 0.038509F, 0.242356F, 1},   {-0.999003F, -0.043301F, 0.010825F, 1},
      {-0.971417F, 0.085268F, -0.221537F, 1},  {-0.969423F, 0.038509F, 0.242356F, 1},
      {0.995136F, 0.095571F, -0.023893F, -1},  {0.961384F, 0.134073F, -0.240346F, -1},
      {0.963155F, 0.072646F, 0.258950F, -1},   {0.961384F, 0.134073F, -0.240346F, -1},
      {0.995566F, 0.091253F, -0.022813F, -1},  {0.963155F, 0.072646F, 0.258950F, -1},
      {-0.969423F, 0.038509F, 0.242356F, 1},   {-0.971417F, 0.085268F, -0.221537F, 1},
      {-0.999984F, -0.005553F, 0.001388F, 1},  {-0.971417F, 0.085268F, -0.221537F, 1},
      {-0.961071F, -0.136435F, 0.240268F, 1},  {-0.999984F, -0.005553F, 0.001388F, 1},
      {0.963155F, 0.072646F, 0.258950F, -1},   {0.995566F, 0.091253F, -0.022813F, -1},
      {0.969035F, 0.047768F, -0.242259F, -1},  {0.995566F, 0.091253F, -0.022813F, -1},
      {0.965730F, -0.165292F, 0.200110F, -1},  {0.969035F, 0.047768F, -0.242259F, -1},
  }};
  const std::vector<glm::vec4> tangents = tangents_of(mesh);
  REQUIRE(tangents.size() == wanted.size());
  for (std::size_t c = 0; c < wanted.size(); ++c) {
    CAPTURE(c);
    CHECK(glm::distance(tangents[c], wanted[c]) < 2e-6F);
  }
}

TEST_CASE("tangent space: a million triangles take a second or so") {
  const TangentMesh mesh = wall(708);
  const double start = quadrille::tests::processor_seconds();
  const std::vector<glm::vec4> tangents = tangents_of(mesh);
  const double seconds = quadrille::tests::processor_seconds() - start;
  CHECK(tangents.size() == mesh.corners.size());
  CHECK(seconds < 2 * quadrille::tests::host_slowness());
}

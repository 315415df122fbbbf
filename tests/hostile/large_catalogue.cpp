/// Scenes of legal members in numbers that nobody draws: each is drawn in time, or refused by its size.
#include <fmt/format.h>

#include "tests/hostile/hostile_case.h"
#include "tests/scenes/gltf_text.h"

namespace quadrille::hostile {
namespace {

/// A file of one triangle mesh whose nodes are given as text.
std::string with_nodes(const std::string& roots, const std::string& nodes) {
  std::string text = scenes::triangle_gltf();
  const std::string scene = R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}])";
  return text.replace(text.find(scene), scene.size(),
                      R"("scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" + nodes + "]");
}

std::string chain(int count) {
  std::string nodes;
  for (int i = 0; i + 1 < count; ++i) nodes += fmt::format("{{\"children\":[{}]}},", i + 1);
  return with_nodes("0", nodes + R"({"mesh":0})");
}

/// `count` nodes that carry `member` each, all roots.
std::string many(int count, const std::string& member) {
  std::string roots, nodes;
  for (int i = 0; i < count; ++i) {
    roots += fmt::format("{}{}", i > 0 ? "," : "", i);
    nodes += (i > 0 ? ",{" : "{") + member + "}";
  }
  return with_nodes(roots, nodes);
}

std::string many_primitives(int count) {
  std::string text = scenes::triangle_gltf();
  const std::string one = R"({"attributes":{"POSITION":0}})";
  std::string all = one;
  for (int i = 1; i < count; ++i) all += "," + one;
  return text.replace(text.find(one), one.size(), all);
}

/// A million nodes of which the first moves.
std::string moving_nodes() {
  std::string text = many(1000000, R"("translation":[1,2,3])");
  const std::vector<float> keys{0, 1, 0, 0, 0, 1, 1, 1};
  const std::string tables =
      R"("bufferViews":[{"buffer":0,"byteLength":36},{"buffer":1,"byteLength":8},{"buffer":1,"byteOffset":8,"byteLength":24}],)"
      R"("animations":[{"samplers":[{"input":1,"output":2}],"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}],)";
  const auto put = [&](const std::string& before, const std::string& what) {
    text.insert(text.find(before) + before.size(), what);
  };
  const std::string views = R"("bufferViews":[{"buffer":0,"byteLength":36}],)";
  text.replace(text.find(views), views.size(), tables);
  put(R"("max":[1,1,0]})",
      R"(,{"bufferView":1,"componentType":5126,"count":2,"type":"SCALAR"},{"bufferView":2,"componentType":5126,"count":2,"type":"VEC3"})");
  text.insert(text.find(']', text.find(R"("buffers":[)")),
              R"(,{"byteLength":32,"uri":")" + scenes::data_uri_of(keys) + "\"}");
  return text;
}

/// Accessors without a buffer view, each read by a primitive of its own.
std::string zeros(int accessors, std::uint64_t count) {
  std::string primitives, list;
  for (int i = 0; i < accessors; ++i) {
    primitives += fmt::format("{}{{\"attributes\":{{\"POSITION\":{}}}}}", i > 0 ? "," : "", i);
    list +=
        fmt::format("{}{{\"componentType\":5126,\"count\":{},\"type\":\"VEC3\"}}", i > 0 ? "," : "", count);
  }
  return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[)" +
         primitives + R"(]}],"accessors":[)" + list + "]}";
}

}  // namespace

Group large_scene_cases() {
  Group group{"large glTF", "legal members in numbers that nobody draws", {}};
  const auto add = [&](const std::string& what, const std::string& text,
                       const std::string& fidelity = "functional") {
    Case c = scene_case(what, text);
    c.arguments = render_arguments("t.gltf", fidelity);
    group.cases.push_back(std::move(c));
  };
  add("a chain of 100,000 nodes", chain(100000));
  add("1,000,000 empty nodes", many(1000000, ""));
  add("2,000,000 empty nodes", many(2000000, ""));
  for (const char* table : {"materials", "textures", "samplers", "scenes"}) {
    for (const int count : {250000, 1300000, 2000000})
      add(fmt::format("{} empty {}", count, table),
          fmt::format(R"({{"asset":{{"version":"2.0"}},"{}":[{{}}{}]}})", table,
                      repeated(",{}", static_cast<std::size_t>(count - 1))));
  }
  const std::string accessor = R"({"componentType":5126,"count":1,"type":"SCALAR"})";
  add("1,300,000 accessors",
      R"({"asset":{"version":"2.0"},"accessors":[)" + accessor + repeated("," + accessor, 1299999) + "]}");
  add("8,000,000 numbers in an extension",
      R"({"asset":{"version":"2.0"},"extensions":{"X":{"a":[0)" + repeated(",0", 8000000) + "]}}}");
  add("1,200,000 objects in an extension",
      R"({"asset":{"version":"2.0"},"extensions":{"X":{"a":[{})" + repeated(R"(,{"":0})", 1200000) + "]}}}");
  add("30,000,000 numbers in extras",
      R"({"asset":{"version":"2.0","extras":[0)" + repeated(",0", 30000000) + "]}}");
  add("8,000,000 numbers in extras",
      R"({"asset":{"version":"2.0","extras":[0)" + repeated(",0", 8000000) + "]}}");
  add("200,000 instances of a mesh", many(200000, R"("mesh":0)"));
  add("1,000,000 instances of a mesh", many(1000000, R"("mesh":0)"));
  add("20,000 primitives", many_primitives(20000));
  add("2,000 draws, exact", many(2000, R"("mesh":0)"), "exact");
  add("100,000 cameras on nodes", many(100000, R"("camera":0)"));
  add("five million zeros", zeros(1, 5000000));
  add("a hundred times five million zeros", zeros(100, 5000000));
  add("100,000 accessors of three zeros", zeros(100000, 3));
  Case moving = scene_case("1,000,000 nodes and an animation", moving_nodes(), "t.gltf", Expect::kRendered);
  moving.arguments = render_arguments("t.gltf", "functional");
  moving.arguments.insert(moving.arguments.end(), {"--animation", "0", "--time", "0.5"});
  group.cases.push_back(std::move(moving));
  return group;
}

}  // namespace quadrille::hostile

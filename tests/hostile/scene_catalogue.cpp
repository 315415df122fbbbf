/// glTF texts that are wrong in one way each: JSON, types, ranges, references, files.
#include <sys/stat.h>

#include <fmt/format.h>

#include "scenes/image/image_io.h"
#include "tests/cli/program.h"
#include "tests/hostile/hostile_case.h"
#include "tests/scenes/gltf_text.h"

namespace quadrille::hostile {
namespace {

using scenes::triangle_gltf;

/// The triangle with its first `from` replaced by `to`.
std::string changed(const std::string& from, const std::string& to) {
  std::string text = triangle_gltf(
      R"(,"material":0)",
      R"(,"materials":[{"pbrMetallicRoughness":{"roughnessFactor":0.5}}],"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}])",
      R"(,"camera":0,"translation":[0,0,0])");
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("the triangle has no " + from);
  return text.replace(at, from.size(), to);
}

void add_json(std::vector<Case>& cases) {
  const std::string good = triangle_gltf();
  const auto add = [&](const std::string& what, const std::string& text, Expect expect = Expect::kRefused) {
    cases.push_back(scene_case("JSON: " + what, text, "t.gltf", expect));
  };
  add("the triangle itself", good, Expect::kRendered);
  add("empty", "");
  add("blank", "   \n");
  add("null", "null");
  add("a number", "5");
  add("an empty array", "[]");
  add("an empty object", "{}");
  add("a string", "\"asset\"");
  add("100,000 brackets", std::string(100000, '['));
  add("100,000 objects", repeated("{\"a\":", 100000) + "1" + std::string(100000, '}'));
  add("an open string", R"({"asset":{"version":"2.0)");
  add("zero bytes", std::string(4096, '\0'));
  add("bytes that are not UTF-8",
      R"({"asset":{"version":"2.0","generator":")" + std::string("\xff\xfe\x80") + "\"}}");
  add("UTF-16", std::string("\xff\xfe{\0}\0", 6));
  add("a byte order mark", "\xef\xbb\xbf" + good, Expect::kEither);
  add("something behind it", good + "}");
  add("a number beyond all", changed("[0,0,0]}", "[1e999,0,0]}"));
  add("NaN", changed("[0,0,0]}", "[NaN,0,0]}"));
  add("one key twice", changed(R"("scene":0)", R"("scene":0,"scene":1)"), Expect::kEither);
  add("a megabyte of one name",
      changed(R"("mesh":0)", R"("mesh":0,"name":")" + std::string(1 << 20, 'n') + "\""), Expect::kRendered);
  add("line feeds and escapes in names",
      changed(R"("mesh":0)", R"("mesh":7,"name":"a\nb\u001b[31m\u0000c")"));
  for (std::size_t size = 1; size < good.size(); size += 23)
    add(fmt::format("cut at byte {}", size), good.substr(0, size));
}

/// The same wrong values at every place where a value stands.
void add_values(std::vector<Case>& cases) {
  const std::vector<std::pair<std::string, std::string>> places{
      {"accessor count", R"("count":3)"},
      {"componentType", R"("componentType":5126)"},
      {"accessor bufferView", R"("bufferView":0)"},
      {"accessor type", R"("type":"VEC3")"},
      {"POSITION", R"("POSITION":0)"},
      {"byteLength", R"("byteLength":36})"},
      {"buffer", R"("buffer":0)"},
      {"scene", R"("scene":0)"},
      {"node", R"("nodes":[0])"},
      {"mesh", R"("mesh":0)"},
      {"material", R"("material":0)"},
      {"camera", R"("camera":0)"},
      {"translation", R"("translation":[0,0,0])"},
      {"yfov", R"("yfov":1)"},
      {"znear", R"("znear":0.1)"},
      {"roughnessFactor", R"("roughnessFactor":0.5)"},
      {"asset", R"("asset":{"version":"2.0"})"},
      {"primitives", R"("primitives":[)"}};
  const std::vector<std::string> values{"-1",  "99",    "2147483648", "1e300",
                                        "0.5", "\"x\"", "null",       "true",
                                        "[]",  "{}",    "[[0]]",      "18446744073709551615"};
  for (const auto& [what, member] : places) {
    const std::size_t colon = member.find(':');
    const std::string key = member.substr(0, colon + 1);
    const std::string tail = member.ends_with("})")    ? ""
                             : member.ends_with("36}") ? "}"
                             : member.ends_with("[")   ? ",\"x\":["
                                                       : "";
    for (const std::string& value : values)
      cases.push_back(scene_case(what + " " + value, changed(member, key + value + tail)));
  }
}

void add_members(std::vector<Case>& cases) {
  const auto add = [&](const std::string& what, const std::string& from, const std::string& to,
                       Expect expect = Expect::kRefused) {
    cases.push_back(scene_case(what, changed(from, to), "t.gltf", expect));
  };
  const std::string acc = R"("count":3)", view = R"("byteLength":36})", node = R"("mesh":0)",
                    material = R"("roughnessFactor":0.5})";
  for (const std::string count : {"2147483647", "4294967296", "9223372036854775807", "1000000000"})
    add("count " + count, acc, R"("count":)" + count);
  add("zeros: a billion elements without a bufferView", R"("bufferView":0,"componentType":5126,"count":3)",
      R"("componentType":5126,"count":1000000000)");
  add("sparse: a billion replacements", acc,
      acc +
          R"(,"sparse":{"count":1000000000,"indices":{"bufferView":0,"componentType":5125},"values":{"bufferView":0}})");
  add("sparse: index beyond", acc,
      acc +
          R"(,"sparse":{"count":1,"indices":{"bufferView":0,"byteOffset":12,"componentType":5125},"values":{"bufferView":0}})");
  add("sparse: negative offset", acc,
      acc +
          R"(,"sparse":{"count":1,"indices":{"bufferView":0,"byteOffset":-4,"componentType":5125},"values":{"bufferView":0}})");
  add("sparse: a number", acc, acc + R"(,"sparse":7)");
  for (const std::string stride : {"1", "3", "253", "-4", "2147483648", "1e10"})
    add("byteStride " + stride, view, R"("byteLength":36,"byteStride":)" + stride + "}");
  for (const std::string offset : {"1", "36", "-1", "4294967295", "9223372036854775807"})
    add("byteOffset " + offset, view, R"("byteLength":36,"byteOffset":)" + offset + "}");
  add("a node that is its own child", node, node + R"(,"children":[0])");
  add("a child that is none", node, node + R"(,"children":[-1])");
  add("children that are no array", node, node + R"(,"children":{"a":0})");
  add("a matrix of 15", node, node + R"(,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0])");
  add("a matrix of words", node, node + R"(,"matrix":["a","b"])");
  add("a rotation of zeros", node, node + R"(,"rotation":[0,0,0,0])");
  add("a scale beyond float", node, node + R"(,"scale":[1e200,1e200,1e200])");
  add("a scale of zero", node, node + R"(,"scale":[0,0,0])", Expect::kEither);
  add("a translation beyond float", R"([0,0,0]})", R"([1e39,0,0]})");
  add("a tiny scale", node, node + R"(,"scale":[1e-40,1e-40,1e-40])", Expect::kEither);
  add("a skin that is none", node, node + R"(,"skin":5)");
  add("a light that is none", node, node + R"(,"extensions":{"KHR_lights_punctual":{"light":3}})");
  add("a light that is a word", node, node + R"(,"extensions":{"KHR_lights_punctual":"sun"})");
  for (const std::string mode : {"-5", "7", "99", "\"4\""})
    add("mode " + mode, R"("material":0)", R"("material":0,"mode":)" + mode);
  for (const std::string mode : {"0", "1", "2", "3"})  // points and lines
    add("mode " + mode, R"("material":0)", R"("material":0,"mode":)" + mode, Expect::kRendered);
  add("indices that are floats", R"("material":0)", R"("material":0,"indices":0)");
  add("baseColorFactor -1", material, R"("baseColorFactor":[-1,1,1,1]})", Expect::kEither);
  for (const std::string factor : {"1e308", "null", "\"a\""})
    add("baseColorFactor " + factor, material, R"("baseColorFactor":[)" + factor + ",1,1,1]}");
  add("baseColorFactor of 3", material, R"("baseColorFactor":[1,1,1]})");
  add("a texture that is none", material, R"("baseColorTexture":{"index":5}})");
  add("a texture that is a word", material, R"("baseColorTexture":"x"})");
  add("alphaMode CLIP", R"("pbrMetallicRoughness")", R"("alphaMode":"CLIP","pbrMetallicRoughness")");
  add("alphaCutoff 1e308", R"("pbrMetallicRoughness")",
      R"("alphaMode":"MASK","alphaCutoff":1e308,"pbrMetallicRoughness")");
  add("emissiveStrength 1e308", R"("pbrMetallicRoughness")",
      R"("emissiveFactor":[1,1,1],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":1e308}},"pbrMetallicRoughness")");
  add("extensionsRequired", R"("scene":0)",
      R"("scene":0,"extensionsRequired":["EXT_of_no\nother\u001b[2J"])");
  add("100,000 extensionsUsed", R"("scene":0)",
      R"("scene":0,"extensionsUsed":[)" + repeated("\"a\",", 99999) + "\"a\"]", Expect::kRendered);
  add("100,000 extensionsRequired", R"("scene":0)",
      R"("scene":0,"extensionsRequired":[)" + repeated("\"a\",", 99999) + "\"a\"]");
  for (const std::string version : {"1.0", "3.0", "", "2", "-2.0", "2.0\\nx"})
    add("version " + version, R"("version":"2.0")", R"("version":")" + version + "\"");
  add("minVersion 2.9", R"("version":"2.0")", R"("version":"2.0","minVersion":"2.9")");
  add("zfar before znear", R"("znear":0.1)", R"("znear":5,"zfar":1)");
  add("near 1e-300", R"("znear":0.1)", R"("znear":1e-300)", Expect::kEither);
  add("a camera that is a fish", R"("type":"perspective")", R"("type":"fish")");
  add("attributes that are an array", R"("attributes":{"POSITION":0})", R"("attributes":[0])");
}

/// {"a":{"b":value}} for a.b
std::string nested(const std::string& path, const std::string& value) {
  const std::size_t dot = path.find('.');
  return "{\"" + path.substr(0, dot) +
         "\":" + (dot == std::string::npos ? value : nested(path.substr(dot + 1), value)) + "}";
}

/// Wrong parts that nothing draws, extensions among them: refused by their place, as the drawn ones are.
void add_parts(std::vector<Case>& cases) {
  const auto add = [&](const std::string& from, const std::string& to, const std::string& place) {
    Case c = scene_case("part: " + to.substr(0, 100), changed(from, to), "t.gltf", Expect::kRefused);
    c.culprit = place;
    cases.push_back(std::move(c));
  };
  const std::string scene = R"("scene":0)", rough = R"("roughnessFactor":0.5})", count = R"("count":3)";
  const std::string lights = R"("extensions":{"KHR_lights_punctual":{"lights":)";
  for (const auto& [part, place] : std::vector<std::pair<std::string, std::string>>{
           {R"("textures":[{"source":7}])", "textures[0].source: image 7 does not exist"},
           {R"("textures":[{},{"sampler":1}])", "textures[1].sampler: sampler 1 does not exist"},
           {R"("textures":[{"extensions":{"EXT_texture_webp":{"source":0}}}])",
            "textures[0].extensions.EXT_texture_webp.source: "},
           {R"("images":[{"bufferView":9}])", "images[0].bufferView: bufferView 9 does not exist"},
           {R"("skins":[{"joints":[0,9]}])", "skins[0].joints[1]: node 9 does not exist"},
           {R"("skins":[{"joints":[0],"skeleton":3}])", "skins[0].skeleton: node 3 does not exist"},
           {R"("skins":[{"joints":[0],"inverseBindMatrices":4}])",
            "skins[0].inverseBindMatrices: accessor 4 does not exist"},
           {R"("animations":[{"samplers":[],"channels":[{"sampler":0,"target":{"path":"scale"}}]}])",
            "animations[0].channels[0].sampler: sampler 0 does not exist (the animation has 0)"},
           {R"("animations":[{"samplers":[{"input":0,"output":8}],"channels":[]}])",
            "animations[0].samplers[0].output: accessor 8 "},
           {R"("extensionsUsed":["A",7])", "extensionsUsed[1]: a string is due"},
           {R"("extensions":[])", "extensions: an object is due"},
           {R"("extensions":{"EXT_any":true})", "extensions.EXT_any: an object is due"},
           {lights + "7}}", "extensions.KHR_lights_punctual.lights: an array is due"},
           {lights + R"([{"type":"sun"}]}})",
            "extensions.KHR_lights_punctual.lights[0].type: one of directional, point, spot is due"},
           {lights + R"([{"type":"spot"}]}})", "extensions.KHR_lights_punctual.lights[0].spot: is missing"},
           {lights + R"([{"type":"point","color":[1,1]}]}})",
            "extensions.KHR_lights_punctual.lights[0].color: "},
           {lights + R"([{"type":"point","range":"far"}]}})",
            "extensions.KHR_lights_punctual.lights[0].range: a number is due"},
           {lights + R"([{"type":null}]}})", "extensions.KHR_lights_punctual.lights[0].type: is missing"}})
    add(scene, scene + "," + part, place);
  const std::string base = R"("baseColorTexture":{"index":0,"extensions":)",
                    to = "materials[0].pbrMetallicRoughness.baseColorTexture";
  add(rough, base + R"({"KHR_texture_transform":"x"}}})",
      to + ".extensions.KHR_texture_transform: an object is due");
  add(rough, base + R"({"KHR_texture_transform":{"offset":[1]}}}})",
      to + ".extensions.KHR_texture_transform.offset: ");
  add(rough, base + R"({"KHR_texture_transform":{"rotation":[]}}}})",
      to + ".extensions.KHR_texture_transform.rotation: ");
  for (const std::string member :
       {"KHR_materials_clearcoat.clearcoatFactor", "KHR_materials_sheen.sheenColorFactor",
        "KHR_materials_ior.ior", "KHR_materials_transmission.transmissionTexture",
        "KHR_materials_volume.thicknessTexture.index"})
    add(rough, rough + ",\"extensions\":" + nested(member, "true"),
        "materials[0].extensions." + member + ": ");
  const std::string sparse =
      count + R"(,"sparse":{"values":{"bufferView":0},"indices":{"bufferView":0,"componentType":5125)";
  add(count, sparse + R"(},"count":4294967297})",
      "accessors[0].sparse.count: an integer of 0 to 2147483647 is due");
  add(count, sparse + R"(,"byteOffset":4294967296},"count":1})",
      "accessors[0].sparse.indices.byteOffset: an integer of 0 to 2147483647 is due");
  // What is left out is said of what is drawn: a refusal stays one line.
  cases.push_back(
      scene_case("part: an extension to be left out, and positions beyond the buffer",
                 R"({"extensionsUsed":["EXT_unheard_of"],)" + changed(count, R"("count":300)").substr(1),
                 "t.gltf", Expect::kRefused));
  add(R"("type":"perspective")", R"("type":"orthographic")", "cameras[0].orthographic: is missing");
  add(R"("asset":{"version":"2.0"})", R"("asset":{"version":"1.1"},"animations":{},"programs":{})",
      "asset.version '1.1'");
}

/// Positions of one value in all places, as the file's bytes.
void add_positions(std::vector<Case>& cases) {
  const auto text = [](float a, float b) {
    return scenes::data_uri_of(std::vector<float>{a, 0, 0, 1, b, 0, 0, 1, a});
  };
  const float infinity = std::numeric_limits<float>::infinity(),
              nan = std::numeric_limits<float>::quiet_NaN();
  const std::string good = scenes::data_uri_of(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  for (const auto& [what, value] : {std::pair{"infinite", infinity},
                                    {"not numbers", nan},
                                    {"the largest", 3.4e38F},
                                    {"denormal", 1e-42F},
                                    {"all zero", 0.0F}})
    cases.push_back(scene_case(fmt::format("positions {}", what), changed(good, text(value, -value))));
}

void add_uris(std::vector<Case>& cases) {
  const std::string good = scenes::data_uri_of(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  const auto add = [&](const std::string& what, const std::string& uri,
                       const std::function<void(const fs::path&)>& more = {}) {
    Case c = scene_case("buffer " + what, changed(good, uri), "t.gltf", Expect::kRefused);
    const auto write = c.prepare;
    c.prepare = [=](const fs::path& folder) { write(folder), more ? more(folder) : void(); };
    cases.push_back(std::move(c));
  };
  for (const std::string uri :
       {"", ".", "..", "/", "/dev/zero", "/dev/stdin", "/proc/self/mem", "http://example.com/a.bin",
        "file:///etc/hostname", "data:", "data:,", "data:;base64,",
        "data:application/octet-stream;base64,!!!!", "%00.bin", "missing.bin", "a\\u0000b", "a\\nb"})
    add("'" + uri + "'", uri);
  add("of a long name", std::string(100000, 'n') + ".bin");
  add("that is a folder", "b.bin", [](const fs::path& f) { fs::create_directory(f / "b.bin"); });
  add("that is a pipe", "b.bin", [](const fs::path& f) { mkfifo((f / "b.bin").c_str(), 0600); });
  add("that is its own link", "b.bin", [](const fs::path& f) { fs::create_symlink("b.bin", f / "b.bin"); });
  add("that is empty", "b.bin", [](const fs::path& f) { write_file(f / "b.bin", ""); });
  add("that is short", "b.bin", [](const fs::path& f) { write_file(f / "b.bin", "0123456789"); });
  add("of three sparse gigabytes", "b.bin",
      [](const fs::path& f) { write_file(f / "b.bin", ""), fs::resize_file(f / "b.bin", 3ULL << 30); });
  add("that may not be read", "b.bin",
      [](const fs::path& f) { write_file(f / "b.bin", ""), fs::permissions(f / "b.bin", fs::perms::none); });
}

/// `one`, `count` times, with commas.
std::string listed(const std::string& one, std::size_t count) { return one + repeated("," + one, count - 1); }

/// Much that is made of one thing: a file is small, and what it asks for is not. The buffer's bytes are those
/// of `data`, then `rest` of `fill`.
void add_shared(std::vector<Case>& cases) {
  struct Buffer {
    std::string data;
    std::size_t rest;
    char fill;
  };
  const auto add = [&](const std::string& what, const Buffer& buffer, const std::string& tables,
                       const std::string& culprit, Expect expect,
                       const std::vector<std::string>& flags = {}) {
    Case c = scene_case("shared: " + what, "", "t.gltf", expect);
    c.culprit = culprit;
    c.arguments = render_arguments("t.gltf", "functional");
    c.arguments.insert(c.arguments.end(), flags.begin(), flags.end());
    const std::size_t bytes = buffer.data.size() + buffer.rest;
    const std::string text = fmt::format(
        R"({{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{0},"uri":"b.bin"}}],"bufferViews":[{{"buffer":0,"byteLength":{0}}}],{1}}})",
        bytes, tables);
    c.prepare = [=](const fs::path& folder) {
      write_file(folder / "t.gltf", text);
      write_file(folder / "b.bin",
                 buffer.data + (buffer.fill == 0 ? "" : std::string(buffer.rest, buffer.fill)));
      fs::resize_file(folder / "b.bin", bytes);
    };
    cases.push_back(std::move(c));
  };
  const auto accessor = [](int component, std::size_t count, const std::string& type,
                           const std::string& more = "") {
    return fmt::format(R"({{"bufferView":0,"componentType":{},"count":{},"type":"{}"{}}})", component, count,
                       type, more);
  };
  const std::string scene = R"("scenes":[{"nodes":[0]}],)", mesh = scene + R"("nodes":[{"mesh":0}],)";
  const auto meshes = [](const std::string& primitives) {
    return R"("meshes":[{"primitives":[)" + primitives + "]}],";
  };
  const auto accessors = [](const std::string& list) { return R"("accessors":[)" + list + "]"; };

  const tests::ScratchFolder folder;
  scenes::save_png((folder.path() / "a.png").string(), {4, 4, std::vector<std::uint8_t>(64, 99)});
  add("a thousand images of one view of 20 MB", {folder.read("a.png"), 20000000, 0},
      mesh + meshes(R"({"attributes":{"POSITION":0}})") + R"("images":[)" +
          listed(R"({"bufferView":0,"mimeType":"image/png"})", 1000) + "]," +
          accessors(accessor(5120, 3, "VEC3")),
      "t.gltf", Expect::kEither, {"--leave-out", "none"});
  add("a million copies of 20,000 primitives", {"", 3 << 22, 0},
      scene +
          R"("nodes":[{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}}],)" +
          meshes(listed(R"({"attributes":{"POSITION":1}})", 20000)) +
          accessors(accessor(5126, 1 << 20, "VEC3") + "," + accessor(5126, 3, "VEC3")),
      "instances of primitives", Expect::kRefused);
  const std::string skinned = R"({"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2},"indices":3})",
                    bones = scene + R"("nodes":[{"mesh":0,"skin":0,"children":[1]},{}],)";
  add("2,000 primitives of a million skinned vertices", {"", 12000000, 1},
      bones + R"("skins":[{"joints":[1,1]}],)" + meshes(listed(skinned, 2000)) +
          accessors(accessor(5126, 1000000, "VEC3") + "," + accessor(5121, 1000000, "VEC4") + "," +
                    accessor(5121, 1000000, "VEC4", R"(,"normalized":true)") + "," +
                    accessor(5121, 3, "SCALAR")),
      "t.gltf", Expect::kRendered);
  add("2,000 primitives of 65,536 joints", {std::string(36, '\xff') + std::string(36, '\x01'), 0, 0},
      bones + R"("skins":[{"joints":[)" + listed("1", 65536) + "]}]," + meshes(listed(skinned, 2000)) +
          accessors(accessor(5126, 3, "VEC3", R"(,"byteOffset":36)") + "," + accessor(5123, 3, "VEC4") + "," +
                    accessor(5121, 3, "VEC4", R"(,"normalized":true)") + "," +
                    accessor(5121, 3, "SCALAR", R"(,"byteOffset":69)")),
      "t.gltf", Expect::kRefused);
  add("10,000 morph targets of one accessor", {"", 1200000, 1},
      mesh + R"("meshes":[{"weights":[)" + listed("1", 10000) +
          R"(],"primitives":[{"attributes":{"POSITION":0},"targets":[)" + listed(R"({"POSITION":0})", 10000) +
          "]}]}]," + accessors(accessor(5126, 100000, "VEC3")),
      "morph targets move more than", Expect::kRefused);
  add("400 MB that are four times as large as floats", {"", 405000000, 0},
      mesh + meshes(R"({"attributes":{"POSITION":0}})") + accessors(accessor(5121, 135000000, "VEC3")),
      "geometry takes more than", Expect::kRefused);
}

}  // namespace

Group scene_cases() {
  Group group{"glTF", "JSON, types, ranges, references and buffers that are wrong in one way each", {}};
  add_json(group.cases);
  add_values(group.cases);
  add_members(group.cases);
  add_parts(group.cases);
  add_positions(group.cases);
  add_uris(group.cases);
  add_shared(group.cases);
  for (const std::string name : {"t.gltf", "t.glb"}) {
    group.cases.push_back({name + " is a folder", render_arguments(name), name,
                           [=](const fs::path& f) { fs::create_directory(f / name); }, Expect::kRefused});
    group.cases.push_back({name + " is a pipe", render_arguments(name), name,
                           [=](const fs::path& f) { mkfifo((f / name).c_str(), 0600); }, Expect::kRefused});
    group.cases.push_back({name + " is a device", render_arguments(name), name,
                           [=](const fs::path& f) { fs::create_symlink("/dev/zero", f / name); },
                           Expect::kRefused});
    group.cases.push_back(
        {name + " is a sparse gigabyte", render_arguments(name), name,
         [=](const fs::path& f) { write_file(f / name, ""), fs::resize_file(f / name, 1ULL << 30); },
         Expect::kRefused});
  }
  return group;
}

}  // namespace quadrille::hostile

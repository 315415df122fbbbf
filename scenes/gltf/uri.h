/// URIs of buffers and images: data URIs, and files beside the scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::scenes {

[[nodiscard]] bool is_data_uri(std::string_view uri);

/// What a URI of the scene file `scene` names: the decoded data, or the whole file. `place` is for errors
/// ("model.gltf: buffers[0]").
///
/// A file is named relative to the scene's folder, percent-encoded or plain, and must lie in that folder or
/// below it: absolute paths, other schemes, and `..` and links that lead out are refused, so that a scene
/// from elsewhere reads nothing but what came with it. [RFC 3986 section 2.1] [RFC 2397] [RFC 4648 section 4]
/// Throws `UserError` for what cannot be decoded or read, or is larger than `max_bytes`.
[[nodiscard]] std::vector<std::byte> fetch_uri(const std::string& scene, std::string_view uri,
                                               const std::string& place, std::uint64_t max_bytes);

/// The file that a relative URI names; the rules of `fetch_uri`.
[[nodiscard]] std::string uri_file(const std::string& scene, std::string_view uri, const std::string& place);

}  // namespace quadrille::scenes

/// tinygltf compiled here from its header, so that the fuzzers see into it and the sanitizers watch it; the
/// program itself links the packaged library.
#define TINYGLTF_IMPLEMENTATION
#include "scenes/gltf/tiny_gltf.h"

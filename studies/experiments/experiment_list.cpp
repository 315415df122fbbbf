/// The experiments that there are, in the order in which they run. A new one is its file and its lines here.
#include "studies/experiments/experiment.h"

namespace quadrille::studies::experiments {
namespace {

const Experiment kExperiments[] = {
    {"memory-scheduling",
     "Memory access scheduling",
     "Rixner and others (Memory Access Scheduling, ISCA 2000), media kernels and applications on one Imagine "
     "processor with in-order "
     "access as the base: "
     "first-ready scheduling raises the sustained bandwidth by 17 % on applications and 40 % on streams, "
     "aggressive reordering by 93 %.",
     "Frames that memory limits, each with four controllers: in order; in order with rows opened ahead; "
     "first-ready; first-ready with "
     "writes drained by watermarks. "
     "Victims leave the L2 cache in "
     "the order of eviction. Bandwidth is bytes moved by the channels over the frame's cycles.",
     &memory_scheduling,
     {"builtin:fill", "builtin:overdraw", "builtin:courtyard"},
     "960x540"},
    {"vertex-reuse",
     "Vertex reuse",
     "Kerbl and others (Revisiting the Vertex Cache, 2018): GPUs reuse vertices within a batch, not through "
     "one cache. The indices 0, 1, 2 "
     "drawn again and again cost a GeForce GTX 1080 Ti three invocations of the vertex shader up to 96 "
     "indices and six at 99; on a Radeon "
     "R7 "
     "200 the step is at 384. meshoptimizer's analyser counts what a mesh costs by such rules.",
     "Every draw of a scene under six policies of vertex fetch, its shaded vertices beside the analyser's "
     "count of the same index lists; "
     "and "
     "the repeated triangle on both sides of the published steps.",
     &vertex_reuse,
     {"builtin:courtyard", "builtin:materials", "builtin:flag", "builtin:quad"},
     "320x180"},
    {"small-triangles",
     "Small triangles",
     "Riccio (How bad are small triangles on GPU and why?, g-truc, 2014), a frame of 1920x1080 filled by "
     "tiles of two triangles, time "
     "against tiles of 128x128: no loss at 16x16 and above, a visible one at 8x8; at 1x1 about 10 times on "
     "Haswell, 15 on Kepler, 20 on "
     "Southern Islands. 256x1 differs from 1x256.",
     "The same tiles, one indexed draw, shaders that hand through, on the default machine with four times "
     "its channels, so that memory is "
     "not the limit, and on machines of the cards' rates. Cycles until the pass is flushed.",
     &small_triangles,
     {},
     "1920x1080"},
    {"setup-rate",
     "Set-up rate",
     "Reviews of the time (gpu-tech.org, GF100 vs. Archmark): up to the GT200 one triangle a clock when it "
     "is culled and half of that when "
     "it is drawn; one drawn a clock on the Radeon HD 5000; 3.5 a clock with the four raster engines of the "
     "GF100.",
     "A mesh of triangles of one pixel each, drawn eight times over: as it is, all culled, and all off "
     "screen. Cycles until the pass is "
     "flushed.",
     &setup_rate,
     {},
     "128x128"},
    {"quad-overhead",
     "Quad overhead",
     "Fatahalian and others (Reducing Shading on GPUs using Quad-Fragment Merging, SIGGRAPH 2010): a "
     "fragment costs at most 4 lanes at one "
     "sample; about 1.4 lanes of 4 are live at triangles of one pixel; with several samples a covered pixel "
     "is shaded more than 8 times.",
     "Frames of triangles of one area each, on the default machine: lanes executed over fragments covered.",
     &quad_overhead,
     {},
     "960x540"},
    {"hidden-surfaces",
     "Hidden surfaces",
     "ATI's Radeon X800 (reviews of 2004: Hexus, AnandTech) drops up to 256 hidden pixels a clock by a "
     "hierarchical depth test of blocks "
     "of 8x8 pixels.",
     "Ten layers over the whole frame, each two triangles, depth test less and depth written: front to back "
     "and back to front, with and "
     "without Hi-Z, on the default machine with four times its channels.",
     &hidden_surfaces,
     {},
     "960x540"},
    {"engines",
     "Raster engines, geometry front ends and cores",
     "Nothing is published to compare with: a bound of our own, 1.5 times from 16 to 64 cores.",
     "Scenes on machines of 16, 32 and 64 cores with 1, 2 and 4 raster engines, and with 2 and 4 geometry "
     "front ends beside four engines; 16 memory channels and 16 screen partitions on each.",
     &engines,
     {"builtin:courtyard", "builtin:cubes"},
     "960x540"},
    {"samples",
     "Samples a pixel",
     "Nothing is published to compare with: each doubling of the samples must bring the picture nearer to "
     "one of 64 "
     "samples, and may cost at most twice the cycles. Shading each sample for itself must bring it nearer "
     "again, at not more than as many times the cycles.",
     "Scenes with 1, 2, 4 and 8 samples a pixel, each pixel shaded once or each sample, on the default "
     "machine: cycles, bytes moved by the memory "
     "channels, and "
     "the error of the picture.",
     &samples,
     {"builtin:cubes", "builtin:courtyard", "builtin:flag"},
     "320x180"},
    {"formats",
     "Colour formats",
     "Nothing is published to compare with: the ruler is arithmetic.",
     "Layers over the whole frame in each format of a colour attachment, opaque and blended, on a machine of "
     "slow ROPs and fast memory.",
     &formats,
     {},
     "256x128"},
    {"color-writes",
     "Colour writes by format",
     "Measured on a GeForce GTX 460 with a bus of 192 bits (GPU Pro series, compressed frame buffers, fig. "
     "4.6): pixels a second by format, blended and not.",
     "Layers over the whole frame in each format, on a machine of that card's rates. Each rate is held to "
     "the "
     "first one's.",
     &color_writes,
     {},
     "512x512"},
    {"compression",
     "Compression of depths and colours",
     "Nothing is published that could be compared byte for byte: the ruler is arithmetic.",
     "Layers over the whole frame, in caches that do not hold it: the bytes that depth units and ROPs "
     "move, "
     "plain and encoded, beside closed forms. Then scenes on the default machine, with 1, 4 and 8 samples a "
     "pixel.",
     &compression,
     {"builtin:courtyard", "builtin:flag"},
     "480x270"},
    {"traversal",
     "Traversal of triangles",
     "Lectures teach two ways (Papaioannou, Rasterization Architectures): edge walking is reasonably good "
     "unless one cares about coherent memory access, several rows at a time, positions of samples or wide "
     "hardware, and thin, elongated triangles make that worse. Nothing is published to compare cycles with: "
     "the ruler is arithmetic.",
     "Frames of one shape of triangles each, by edge functions and by edge walking, on a machine of 16 "
     "cores, "
     "8 channels and 16 tile tests a cycle, so that the rasteriser is the limit. The work is counted by a "
     "rasteriser of its own, before the frame is drawn. Then scenes on the default machine. Cycles until the "
     "pass is flushed.",
     &traversal,
     {"builtin:courtyard", "builtin:flag"},
     "256x256"},
    {"raster",
     "The end of the pipeline",
     "Nothing is published that could be compared byte for byte: the ruler is arithmetic.",
     "Layers over a frame larger than the caches, with one thing changed at a time: Hi-Z, its least depths, "
     "clear or load, blending, stencil.",
     &raster,
     {},
     "512x256"},
    {"depth-precision",
     "Depth precision",
     "Nothing is published that could be compared value for value: the ruler is exact arithmetic and the "
     "theory "
     "of rounding.",
     "Pairs of surfaces at 64 distances between the planes, in 32 steps closer to each other, in each "
     "format, "
     "standard and reversed, for planes up to a billion times apart.",
     &depth_precision,
     {},
     "256x128"},
    {"blend-drift",
     "Blending drift",
     "Nothing is published to compare with: the ruler is exact arithmetic and the theory of rounding.",
     "Ten thousand layers of unlike colours, blended by *over* with 16 alphas, in four formats.",
     &blend_drift,
     {},
     "16x16"},
    {"transparency",
     "Order-independent transparency",
     "Nothing is published to compare with: the ruler is the exact picture. An A-buffer must reach it, more "
     "layers of a k-buffer must come nearer to it, and both must be nearer than sorted draws.",
     "Panes of glass that cut through each other (`builtin:glass`), with 1 and 4 samples a pixel, on the "
     "default machine: sorted by the centres of their boxes, by k-buffers of 1, 2, 4 and 8 layers, and by an "
     "A-buffer.",
     &transparency,
     {},
     "480x300"},
    {"texture-cache",
     "Texture caches",
     "Hakura and Gupta (The Design and Analysis of a Cache Architecture for Texture Mapping, ISCA 1997): "
     "working sets of at most 16 KiB, 3 to 15 times less bandwidth than without a cache, and tiled orders of "
     "pixels better than rows. Hit rates of seven scenes on hardware (CRISP): 74 to 95 % in the first level, "
     "68 "
     "to 99 % in the second.",
     "Scenes on a machine of one core, so that one cache sees all samples: its size, its ways, and the order "
     "in "
     "which tiles are drawn. Then the default machine, whose hit rates stand beside the published ones.",
     &texture_cache,
     {"builtin:quad", "builtin:cubes", "builtin:courtyard"},
     "640x360"},
    {"texture-latency",
     "Fetching ahead",
     "Igehy, Eldridge and Proudfoot (Prefetching in a Texture Cache Architecture, 1998): with enough "
     "fragments "
     "between addresses and filter, at least 97 % of the speed of a memory without latency.",
     "Layers over the frame, each of whose samples misses the first-level cache and hits the L2 cache: the "
     "places between addresses and filter, and the latency of the L2 cache.",
     &texture_latency,
     {},
     "256x128"},
    {"texture-filters",
     "Filtering rates",
     "Reviews of cards (beyond3d): trilinear samples at half the rate of bilinear ones; texels of four "
     "16-bit "
     "floats at half the rate of four bytes, or at the full one, by generation.",
     "Layers over the frame, each pixel one sample, on a machine whose filters are the limit.",
     &texture_filters,
     {},
     "128x128"},
    {"compressed-textures",
     "Compressed textures",
     "Nystad and others (Adaptive Scalable Texture Compression, High Performance Graphics 2012): at 3.56 "
     "bits "
     "a texel ASTC is nearer the original than S3TC and ETC2 at 4.",
     "A texel a pixel in each format, whose bytes are known. Then scenes whose textures of RGBA8 were "
     "compressed by libsquish and libastcenc, each on the default machine, and their pictures beside that of "
     "RGBA8.",
     &compressed_textures,
     {"builtin:courtyard", "builtin:materials"},
     "480x270"},
    {"units",
     "Every unit by itself",
     "Nothing is published to compare with: the ruler is arithmetic.",
     "For each kind of unit a frame that it limits, whose cycles follow from its work and its parameters, "
     "and "
     "a frame that it does not limit, in which half and twice its main rate must change nothing. Predictions "
     "come from the command stream and the machine's parameters, before the frame is drawn.",
     &units,
     {},
     "128x128"},
    {"limits",
     "What limits a frame",
     "Nothing is published to compare with: the ruler is the machine itself, drawn again with one resource "
     "doubled.",
     "Frames on machines that are narrow at different places. The report of each frame, from its one run, "
     "names the doublings that it "
     "expects to gain most. Then every resource is doubled by itself, and the gains are measured.",
     &limits,
     {"builtin:cubes", "builtin:materials", "builtin:flag", "builtin:overdraw"},
     "160x90"},
    {"parameters",
     "Every parameter by itself",
     "Nothing is published to compare with: each parameter is held to what it declares of itself.",
     "Small frames on a few machines, each drawn again with one parameter changed. More of a resource shall "
     "slow no frame by more than 1 "
     "%, and every parameter shall do something somewhere.",
     &parameters,
     {"builtin:cubes", "builtin:flag", "builtin:overdraw", "builtin:fill", "builtin:quad"},
     "160x90"},
};

}  // namespace

std::span<const Experiment> experiments() { return kExperiments; }

}  // namespace quadrille::studies::experiments

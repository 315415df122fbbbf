# Every outside library, found once. The Debian packages that hold them are listed in scripts/packages.txt.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(glm REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Protobuf REQUIRED)  # timelines for Perfetto
find_package(TinyGLTF REQUIRED)
find_package(meshoptimizer REQUIRED)
pkg_check_modules(DRACO REQUIRED IMPORTED_TARGET draco)
find_package(zstd REQUIRED)
pkg_check_modules(LZ4 REQUIRED IMPORTED_TARGET liblz4)  # captures of gfxreconstruct
find_package(SQLite3 REQUIRED)  # results of sweeps
find_package(muparser REQUIRED)  # their formulas
find_package(OpenTURNS REQUIRED)  # their designs
find_package(pagmo REQUIRED)  # their searches
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
find_package(astcenc REQUIRED)  # ASTC: textures compressed on load, and a second decoder
find_package(PNG REQUIRED)
find_package(JPEG REQUIRED)
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET OpenImageIO)
pkg_check_modules(WEBP REQUIRED IMPORTED_TARGET libwebp)
pkg_check_modules(SYSTEMC_PC REQUIRED IMPORTED_TARGET systemc)
find_package(SPIRV-Headers REQUIRED)
find_package(SPIRV-Tools REQUIRED)
find_package(SPIRV-Tools-opt REQUIRED)
find_package(SPIRV-Tools-link REQUIRED)
find_package(glslang REQUIRED)

# Debian's SystemC 2.3.4 was built as C++17 and checks the macro at link time.
add_library(quadrille_systemc INTERFACE)
target_link_libraries(quadrille_systemc INTERFACE PkgConfig::SYSTEMC_PC)
target_compile_definitions(quadrille_systemc INTERFACE SC_CPLUSPLUS=201703L SC_INCLUDE_DYNAMIC_PROCESSES)

# Debian's libsquish.pc names a folder that does not exist.
find_path(SQUISH_INCLUDE squish.h REQUIRED)
find_library(SQUISH_LIBRARY squish REQUIRED)
add_library(quadrille_squish INTERFACE)
target_include_directories(quadrille_squish SYSTEM INTERFACE ${SQUISH_INCLUDE})
target_link_libraries(quadrille_squish INTERFACE ${SQUISH_LIBRARY})

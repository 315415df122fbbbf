/// The texts of scenes/material/shaders/, put into the program when it is built.
#pragma once

#include <string_view>

namespace quadrille::scenes {

extern const std::string_view kInterfaceGlsl, kPoseGlsl, kMaterialGlsl, kLayersGlsl, kLightGlsl,
    kEnvironmentGlsl, kBackgroundVert, kBackgroundFrag, kMaterialVert, kMaterialFrag, kVisibilityFrag,
    kLectureFrag, kValuesFrag, kOverdrawFrag;

}  // namespace quadrille::scenes

/// How functions of the module of designs end: no exception leaves them.
#pragma once

#include <cstdio>
#include <exception>

#include "studies/explore/design_module.h"

namespace quadrille {

/// Runs `work`; what it throws becomes the message.
template <class Work>
bool guarded_call(QuadrilleMessage* message, const Work& work) {
  try {
    work();
    return true;
  } catch (const std::exception& error) {
    std::snprintf(message->text, sizeof(message->text), "%s", error.what());
  }
  return false;
}

}  // namespace quadrille

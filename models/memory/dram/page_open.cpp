/// Open pages: a row stays open until another row of its bank is wanted.
#include "models/memory/dram/page_policy.h"

namespace quadrille::models {

constinit const DramPagePolicyEntry kOpenPages{
    "open", "a row stays open until its bank needs another one: the next request to it is a hit",
    [](const DramPageSetup& /*setup*/) { return std::make_unique<DramPagePolicy>(); }};

}  // namespace quadrille::models

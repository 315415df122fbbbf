/// The main function of this folder's test program.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

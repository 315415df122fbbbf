/// The main function of every test program. SystemC's library refers to `sc_main`, which a program with a
/// main of its own never calls; weak, so that a library of test helpers may bring its own.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

extern "C" __attribute__((weak)) int sc_main(int, char**) { return 0; }

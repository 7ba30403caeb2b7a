#include "app/commands.h"
#include "bench/bench_command.h"
#include "bench/harness/child.h"

int main(int argc, char** argv) {
  return saccade::app::runProgram(argc, argv,
                                  {saccade::bench::addBenchCommand, saccade::bench::addChildCommand});
}

#include "app/commands.h"

int main(int argc, char** argv) { return saccade::app::runProgram(argc, argv); }

// How often this test program has asked for memory.
#pragma once

namespace saccade::tests {

/// Calls of operator new since the program's start, by all threads. Any thread.
long allocationCount();

}  // namespace saccade::tests

#pragma once

namespace kingpin::apps {

/// From now on Ctrl-C sets a flag instead of ending the program; a second one ends it.
void CatchInterrupt();

/// True after Ctrl-C.
bool WasInterrupted();

}  // namespace kingpin::apps

#pragma once

#include <string>

namespace kingpin::apps {

/// From now on Ctrl-C, SIGTERM and SIGHUP set a flag instead of ending the program; another
/// one later ends it. A signal that whoever started the program has it ignore (nohup) stays
/// ignored.
void CatchInterrupt();

/// True after one of them.
bool WasInterrupted();

/// `stopped by Ctrl-C`, or by whatever it was.
std::string FormatInterrupt();

}  // namespace kingpin::apps

#pragma once

#include <string>

#include "optimisation/report/study_report_data.h"

namespace kingpin::report {

/// A Pareto front: non-dominated points joined by a staircase (between two of them nothing better
/// is known), other designs pale, named designs marked and labelled.
std::string DrawParetoChart(const ParetoFront& front, double width);

}  // namespace kingpin::report

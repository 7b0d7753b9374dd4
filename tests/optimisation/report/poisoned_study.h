#pragma once

#include <string>

#include "tests/optimisation/report/sample_study.h"

/// The sample study with markup in every text; run, it would leave an error mark in the page.
namespace kingpin::report::sample {

inline const std::string kPoison =
    "</script></title><script>document.documentElement.setAttribute('data-errors','injected')"
    "</script><img src=x onerror=\"alert(1)\">&\"' r_<b> {} %s";

inline void Poison(std::string& text) { text += kPoison; }
inline void Poison(DisplayUnit& unit) { Poison(unit.text); }
inline void Poison(NamedText& t) {
  Poison(t.name);
  Poison(t.text);
}
inline void Poison(std::vector<std::string>& texts) {
  for (std::string& text : texts) Poison(text);
}
inline void Poison(ParetoFront& f) {
  for (std::string* s : {&f.name, &f.x_name, &f.x_unit.text, &f.y_name, &f.y_unit.text, &f.note}) {
    Poison(*s);
  }
  for (ParetoPoint& p : f.marked) Poison(p.name);
}
inline void Poison(Comparison& c) {
  Poison(c.title);
  Poison(c.columns);
  Poison(c.note);
  for (ComparisonRow& r : c.rows) {
    for (std::string* s : {&r.symbol, &r.name, &r.unit.text, &r.note}) Poison(*s);
  }
}
inline void Poison(Case& c) {
  for (std::string* s : {&c.name, &c.description, &c.verdict, &c.spectrum_name,
                         &c.spectrum_unit.text, &c.weighting_name}) {
    Poison(*s);
  }
  for (Design& d : c.designs) {
    for (std::string* s : {&d.name, &d.note, &d.geometry.name}) Poison(*s);
    for (Mode& m : d.modes) Poison(m.shape);
  }
  for (Channel& channel : c.channels) {
    for (std::string* s : {&channel.name, &channel.symbol, &channel.unit.text}) Poison(*s);
  }
  for (Response& r : c.responses) {
    Poison(r.name);
    Poison(r.unit);
  }
  for (Characteristic& x : c.characteristics) {
    for (std::string* s : {&x.name, &x.x_name, &x.x_unit.text, &x.y_name, &x.y_unit.text})
      Poison(*s);
  }
  for (Variable& v : c.variables) {
    for (std::string* s : {&v.symbol, &v.name, &v.unit.text}) Poison(*s);
  }
  for (Stage& stage : c.stages) {
    for (std::string* s : {&stage.name, &stage.algorithm, &stage.free, &stage.status}) Poison(*s);
  }
  for (Convergence& h : c.convergence) Poison(h.name);
  for (Restarts& r : c.restarts) Poison(r.name);
  for (ActiveConstraint& a : c.active) {
    for (std::string* s : {&a.design, &a.name, &a.unit.text, &a.effect}) Poison(*s);
  }
  for (Sensitivity& t : c.sensitivities) {
    for (std::string* s : {&t.design, &t.unit, &t.meaning}) Poison(*s);
    Poison(t.variables);
    Poison(t.measures);
  }
  for (ParetoFront& f : c.pareto) Poison(f);
  for (Comparison& comparison : c.comparisons) Poison(comparison);
  Poison(c.warnings);
}

inline StudyReportData MakePoisonedStudy() {
  StudyReportData data = MakeSampleStudy();
  for (std::string* s :
       {&data.title, &data.subtitle, &data.created, &data.program, &data.command}) {
    Poison(*s);
  }
  Poison(data.summary);
  Poison(data.warnings);
  for (Measure& m : data.measures) {
    for (std::string* s : {&m.symbol, &m.name, &m.unit.text, &m.definition}) Poison(*s);
  }
  for (Case& c : data.cases) Poison(c);
  for (Comparison& c : data.comparisons) Poison(c);
  Poison(data.further.text);
  Poison(data.further.ratio_symbols);
  for (FurtherRow& r : data.further.rows) {
    for (std::string* s : {&r.name, &r.freedom, &r.note}) Poison(*s);
  }
  for (ParetoFront& f : data.further.pareto) Poison(f);
  for (ParameterGroup& g : data.parameters) {
    Poison(g.title);
    Poison(g.source);
    for (Parameter& p : g.parameters) {
      for (std::string* s : {&p.name, &p.value, &p.unit, &p.origin}) Poison(*s);
    }
  }
  for (auto* list : {&data.options, &data.conventions, &data.solver, &data.versions}) {
    for (NamedText& t : *list) Poison(t);
  }
  for (InputFile& f : data.inputs) {
    Poison(f.path);
    Poison(f.hash);
  }
  return data;
}

}  // namespace kingpin::report::sample

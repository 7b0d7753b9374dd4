#include "core/mechanism/entries.h"

#include <algorithm>

#include "core/mechanism/segments.h"

namespace kingpin::mechanism {

namespace {

// Calls `entry(i, j)` for the entries of coordinate i in M, in the order of Model::mass_slots.
template <class Entry>
void ListMassEntries(const Model& model, int i, const Entry& entry) {
  for (int j = i; j >= 0; j = model.segment_parent[j]) entry(i, j);
  const int segment = model.segment[model.dof_link[i]];
  if (segment == 0) return;
  for (int c = 0; c < 6; ++c) entry(i, model.GetCutCoordinate(segment) + c);
}

}  // namespace

std::vector<std::pair<int, int>> ListEntries(const Model& model) {
  std::vector<std::pair<int, int>> entries;
  const auto add = [&](int i, int j) { entries.emplace_back(std::max(i, j), std::min(i, j)); };
  for (int i = 0; i < model.velocities; ++i) ListMassEntries(model, i, add);
  for (int s = 1; s <= model.CountCuts(); ++s) ListCutEntries(model, s, add, [](int) {});
  for (int r = 0; r < model.rows; ++r) {
    if (model.IsLeftOut(r)) continue;
    for (int s = model.row_term_begin[r]; s < model.row_term_begin[r + 1]; ++s) {
      add(model.coordinates + r, model.row_terms[s].dof);
    }
  }
  for (const Model::CutTerm& term : model.cut_terms) {
    if (model.IsLeftOut(term.row)) continue;
    for (int c = 0; c < 6; ++c) {
      add(model.coordinates + term.row, model.GetCutCoordinate(term.segment) + c);
    }
  }
  for (const LinearRow& row : model.linear) {
    if (model.IsLeftOut(row.row)) continue;
    for (const LinearRow::Term& term : row.terms) add(model.coordinates + row.row, term.v);
  }
  std::sort(entries.begin(), entries.end());
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
  return entries;
}

void SetSlots(Model& model) {
  const auto get = [&](int i, int j) { return model.pattern.GetSlot(i, j); };
  model.mass_slots.clear();
  model.mass_begin.assign(1, 0);
  for (int i = 0; i < model.velocities; ++i) {
    ListMassEntries(model, i, [&](int a, int b) { model.mass_slots.push_back(get(a, b)); });
    model.mass_begin.push_back(static_cast<int>(model.mass_slots.size()));
  }
  model.cut_slots.clear();
  for (int l = static_cast<int>(model.links.size()) - 1; l > 0; --l) {
    if (model.starts_segment[l] == 0) continue;
    ListCutEntries(
        model, model.starts_segment[l], [&](int i, int j) { model.cut_slots.push_back(get(i, j)); },
        [&](int i) { model.cut_slots.push_back(model.pattern.GetRightSideSlot(i)); });
  }
  for (int r = 0; r < model.rows; ++r) {
    if (model.IsLeftOut(r)) continue;
    for (int s = model.row_term_begin[r]; s < model.row_term_begin[r + 1]; ++s) {
      model.row_terms[s].slot = get(model.row_terms[s].dof, model.coordinates + r);
    }
  }
  for (Model::CutTerm& term : model.cut_terms) {
    if (model.IsLeftOut(term.row)) continue;
    for (int c = 0; c < 6; ++c) {
      term.slots[c] = get(model.coordinates + term.row, model.GetCutCoordinate(term.segment) + c);
    }
  }
  model.linear_slots.clear();
  for (const LinearRow& row : model.linear) {
    if (model.IsLeftOut(row.row)) continue;
    for (const LinearRow::Term& term : row.terms) {
      model.linear_slots.push_back(get(term.v, model.coordinates + row.row));
    }
  }
  std::vector<char> written(model.pattern.size(), 0);
  const auto mark = [&](const std::vector<int>& slots) {
    for (int slot : slots) written[slot] = 1;
  };
  mark(model.mass_slots);
  mark(model.cut_slots);
  mark(model.linear_slots);
  for (int i = 0; i < model.velocities; ++i) written[model.pattern.GetRightSideSlot(i)] = 1;
  for (int r = 0; r < model.rows; ++r) {
    written[model.pattern.position(model.coordinates + r)] = 1;
    written[model.pattern.GetRightSideSlot(model.coordinates + r)] = 1;
    for (int s = model.row_term_begin[r]; s < model.row_term_begin[r + 1]; ++s) {
      if (!model.IsLeftOut(r)) written[model.row_terms[s].slot] = 1;
    }
  }
  for (const Model::CutTerm& term : model.cut_terms) {
    for (int slot : term.slots) written[slot] |= !model.IsLeftOut(term.row);
  }
  model.fill_slots.clear();
  for (int slot = 0; slot < model.pattern.size(); ++slot) {
    if (!written[slot]) model.fill_slots.push_back(slot);
  }
}

}  // namespace kingpin::mechanism

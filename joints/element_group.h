#pragma once

#include <string>
#include <vector>

#include "core/mechanism/system.h"

namespace kingpin::joints {

/// Elements of one type as a force group. An element has
///
///   template <class S> void AddForces(const ForceContext<S>&) const;
///   mechanism::EnergyRates CalcEnergy(const ForceContext<double>&) const;
template <class Element>
class ElementGroup final : public mechanism::ForceGroup {
 public:
  void Add(std::string name, Element element) {
    names_.push_back(std::move(name));
    elements_.push_back(std::move(element));
  }
  const std::vector<std::string>& names() const { return names_; }
  const std::vector<Element>& elements() const { return elements_; }

  void AddForces(const mechanism::ForceContext<double>& context) const override {
    for (const Element& element : elements_) element.AddForces(context);
  }
  void AddForces(const mechanism::ForceContext<mechanism::Dual8>& context) const override {
    for (const Element& element : elements_) element.AddForces(context);
  }
  mechanism::EnergyRates CalcEnergy(const mechanism::ForceContext<double>& context) const override {
    mechanism::EnergyRates sum;
    for (const Element& element : elements_) {
      const mechanism::EnergyRates rates = element.CalcEnergy(context);
      sum.potential += rates.potential;
      sum.dissipated += rates.dissipated;
      sum.supplied += rates.supplied;
    }
    return sum;
  }
  std::string FindNotFinite(const mechanism::ForceContext<double>& context) const override {
    for (size_t i = 0; i < elements_.size(); ++i) {
      mechanism::ClearForces(context.w);
      elements_[i].AddForces(context);
      if (!mechanism::ForcesAreFinite(context.w)) return '\'' + names_[i] + '\'';
    }
    return "";
  }

 private:
  std::vector<std::string> names_;
  std::vector<Element> elements_;
};

/// A law F(t, x, ẋ) at a place of force_place.h. A law has
///
///   template <class S> S CalcForce(const S& time, const S& x, const S& rate) const;
///   mechanism::EnergyRates CalcEnergy(double time, double x, double rate) const;
///
/// with F positive when it makes x grow.
template <class Place, class Law>
struct LawAtPlace {
  Place place;
  Law law;

  template <class S>
  void AddForces(const mechanism::ForceContext<S>& context) const {
    const auto value = place.Calc(context);
    place.Apply(context, value, law.CalcForce(context.time, value.x, value.rate));
  }
  mechanism::EnergyRates CalcEnergy(const mechanism::ForceContext<double>& context) const {
    const auto value = place.Calc(context);
    return law.CalcEnergy(context.time, value.x, value.rate);
  }
};

}  // namespace kingpin::joints

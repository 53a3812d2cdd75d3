#include "bench/collision_command.h"

#include "bench/broad_phase_study.h"
#include "bench/contact_study.h"
#include "bench/contact_time_study.h"
#include "bench/narrow_phase_study.h"
#include "bench/write_csv.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <string>

namespace signorini::bench {
namespace {

constexpr int kClaimsHold = 0;
constexpr int kWrongClaim = 1;

}  // namespace

struct CollisionCommand::Options {
  ContactStudyOptions contacts;
  ContactTimeOptions contact_times;
  BroadPhaseOptions broad_phase;
  NarrowPhaseOptions narrow_phase;
  std::string out;
};

CollisionCommand::CollisionCommand(CLI::App& app) : options_(std::make_unique<Options>()) {
  Options& o = *options_;
  contacts_ = app.add_subcommand(
      "contacts",
      "Distances and contact sets of every pair of shapes at random and near-degenerate "
      "poses, judged by their properties");
  contacts_->add_option("--poses", o.contacts.poses, "Of each pair")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  contacts_->add_option("--pair", o.contacts.pair, "One pair alone, such as sphere-box");
  contacts_->add_option("--seed", o.contacts.seed, "Of the random numbers")->capture_default_str();
  contact_times_ = app.add_subcommand(
      "contact-times",
      "Contact times of random throws of every pair of shapes, against samples and a bisection of "
      "the gap");
  contact_times_->add_option("--throws", o.contact_times.throws, "Of all pairs together")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  contact_times_->add_option("--seed", o.contact_times.seed, "Of the random numbers")
      ->capture_default_str();
  broad_phase_ = app.add_subcommand(
      "broad-phase", "Moving boxes: our broad phase beside Bullet's, FCL's and Boost's");
  broad_phase_->add_option("--bodies", o.broad_phase.bodies, "How many boxes")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  broad_phase_->add_option("--steps", o.broad_phase.steps, "Of each motion")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  narrow_phase_ = app.add_subcommand(
      "narrow-phase",
      "Contact sets of touching shapes: time and valid points beside Bullet's and FCL's");
  narrow_phase_->add_option("--poses", o.narrow_phase.poses, "Of each pair")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  narrow_phase_
      ->add_option("--repeats", o.narrow_phase.repeats, "Of all poses; the least time counts")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  narrow_phase_->add_option("--pair", o.narrow_phase.pair, "One pair alone, such as hull-hull");
  for (CLI::App* study : {contacts_, contact_times_, broad_phase_, narrow_phase_}) {
    study->add_option("--out", o.out, "Folder for the CSV, made if absent (default: print only)");
  }
}

CollisionCommand::~CollisionCommand() = default;

bool CollisionCommand::is_asked() const {
  return contacts_->parsed() || contact_times_->parsed() || broad_phase_->parsed() ||
         narrow_phase_->parsed();
}

int CollisionCommand::run() const {
  if (!options_->out.empty()) {
    std::filesystem::create_directories(options_->out);
  }
  if (contacts_->parsed()) {
    const ContactStudyReport report = run_contact_study(options_->contacts, std::cout);
    write_csv(options_->out, "contacts", report.to_csv());
    return report.passed() ? kClaimsHold : kWrongClaim;
  }
  if (contact_times_->parsed()) {
    const ContactTimeReport report = run_contact_time_study(options_->contact_times, std::cout);
    write_csv(options_->out, "contact-times", report.to_csv());
    return report.passed() ? kClaimsHold : kWrongClaim;
  }
  if (narrow_phase_->parsed()) {
    const NarrowPhaseReport report = run_narrow_phase_study(options_->narrow_phase, std::cout);
    write_csv(options_->out, "narrow-phase", report.to_csv());
    return kClaimsHold;
  }
  const BroadPhaseReport report = run_broad_phase_study(options_->broad_phase, std::cout);
  write_csv(options_->out, "broad-phase", report.to_csv());
  return report.passed() ? kClaimsHold : kWrongClaim;
}

}  // namespace signorini::bench

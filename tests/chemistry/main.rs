//! Equations, the engine that solves them, and fields.

mod delays;
mod documents;
mod eml;
mod eml_algebraic;
mod eml_include;
mod eml_models;
mod eml_reactions;
mod eml_repeat;
mod eml_schedules;
mod eml_starts;
mod eml_tables;
mod eml_write;
mod engine_events;
mod engine_members;
mod engine_nothing;
mod engine_order;
mod engine_program;
mod engine_stiff;
mod engine_switches;
mod field_defaults;
mod field_documents;
mod field_line;
mod field_system;
mod field_transport;
mod field_walls;
mod fields;
mod fields_analytic;
mod fields_beside;
mod fields_clock;
mod noise;
mod sbml;
mod sbml_algebraic;
mod sbml_events;
mod sbml_fast;
mod sbml_features;
mod sbml_write;
mod xml;

#[path = "../support/every_function.rs"]
mod every_function;
#[path = "../support/ode_problems.rs"]
mod ode_problems;
#[path = "../support/sbml_models.rs"]
mod sbml_models;
#[path = "../support/sbml_suite.rs"]
mod sbml_suite;
#[path = "../support/shared.rs"]
mod shared;

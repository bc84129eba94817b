//! Cells move, stick and feel chemistry as the equations of the book say.

mod areas;
mod atoms;
mod beside_fields;
mod bonds;
mod cohesion;
mod contact;
mod contact_fuzz;
mod contact_inhibition;
mod contact_models;
mod contact_order;
mod corners;
mod coupling;
mod coupling_line;
mod events;
mod fibres;
mod forces;
mod friction;
mod gel_face;
mod glossary;
mod indentation;
mod inertial;
mod levels;
mod made_fibres;
mod membranes;
mod modulus;
mod motility;
mod moved;
mod neighbours;
mod noise;
mod ordering;
mod own_stiffness;
mod own_stiffness_touching;
mod population;
mod prediction;
mod pressure;
mod pseudopods;
mod receptors;
mod rigid;
mod sensing;
mod soft_cells;
mod solids;
mod sphere;
mod stability_limits;
mod step;
mod tools;
mod torques;
mod tractions;
mod virtual_adhesives;
mod viscosity;
mod viscous_bodies;
mod walk;

#[path = "../support/contact_scenes.rs"]
mod contact_scenes;
#[path = "../support/coupled_scene.rs"]
mod coupled_scene;
#[path = "../support/everything.rs"]
mod everything;
#[path = "../support/index_table.rs"]
mod index_table;
#[path = "../support/same_bits.rs"]
mod same_bits;
#[path = "../support/sbml_suite.rs"]
mod sbml_suite;
#[path = "../support/shared.rs"]
mod shared;

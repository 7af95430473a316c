//! Planar multibody mechanisms: assembly, inverse and forward dynamics. Theory and sources: `docs/theory/multibody.md`.
//!
//! Describe a mechanism with [`Model`], check it with [`Model::build`], then ask the [`System`]: [`System::assemble`] for a position,
//! [`System::inverse`] for the forces of a prescribed motion, [`System::simulate`] for the motion under given forces.
//!
//! A driven slider-crank and the torque that it takes:
//!
//! ```
//! use forcewright_multibody::{Body, GROUND, Grid, Kinematics, Model, Motion, Stop};
//!
//! let mut model = Model::new();
//! let crank = model.body("crank", Body::rod(0.2, 0.05).placed(0.0, 0.0, 0.5));
//! let rod = model.body("rod", Body::rod(0.3, 0.15).placed(0.044, 0.024, -0.16));
//! let slider = model.body("slider", Body::new(0.5, 0.0).placed(0.19, 0.0, 0.0));
//! model.revolute("main pin", crank.at(0.0, 0.0), GROUND.at(0.0, 0.0));
//! model.revolute("crank pin", rod.at(0.0, 0.0), crank.at(0.05, 0.0));
//! model.revolute("wrist pin", slider.at(0.0, 0.0), rod.at(0.15, 0.0));
//! model.prismatic("guide", slider.at(0.0, 0.0), GROUND.at(0.0, 0.0), 0.0, 0.0);
//! let motor = model.drive_angle("motor", crank, GROUND, Motion::Polynomial { start: 0.5, rate: 100.0, acceleration: 0.0 });
//! let system = model.build()?;
//! let run = system.inverse(system.guess(), Grid { start_s: 0.0, end_s: 0.0628, steps: 100 }, Kinematics::Algebraic);
//! assert_eq!(run.stop, Stop::Reached);
//! let torque_nm = run.history.iter().filter_map(|instant| system.driver_force(&instant, motor)).fold(0.0, f64::max);
//! assert!(torque_nm > 1.0 && torque_nm < 20.0);
//! # Ok::<(), forcewright_multibody::ModelError>(())
//! ```

mod assembly;
mod body;
mod dynamics;
mod energy;
mod error;
mod forces;
mod forward;
mod frames;
mod history;
mod integrator;
mod inverse;
mod kkt;
mod law;
mod model;
mod motion;
mod ode;
mod path;
mod rows;

pub use assembly::Assembled;
pub use body::{Body, BodyId, GROUND, Point, Pose};
pub use energy::{Energy, EnergyAudit};
pub use error::{AssemblyError, ModelError, Stop};
pub use forces::{Force, ForceFunction, Load, Torque};
pub use forward::{Crossing, Event, Hit, Method, Outputs, Settings, Simulation};
pub use frames::Snapshot;
pub use history::{ContactForce, History, Instant, Reaction};
pub use inverse::{Grid, Inverse, Kinematics};
pub use law::{Law, Table, TableError};
pub use model::{Contact, JointId, Model, System};
pub use motion::Motion;
pub use ode::{Ended, Ode, OdeSettings, Trajectory, integrate};
pub use path::{Curve, Follows, Path, PathPoint, Side};

//! Breaches that are made up, to show that each rule catches what it is for and lets pass what is allowed.

use super::circles::{circles, needs};
use super::house::House;
use super::sources::Source;
use super::{breaches, campaign, floors, width};

/// A house of these modules with their texts, and of the empty ones that they stand in.
pub(crate) fn house(modules: &[(&str, &str)]) -> House {
    let mut all: Vec<(&str, &str)> = modules.to_vec();
    for (module, _) in modules {
        let above = module.match_indices("::").map(|(end, _)| (&module[..end], ""));
        all.extend(above.filter(|(path, _)| !modules.iter().any(|(module, _)| module == path)));
    }
    let source = |(module, text): &(&str, &str)| Source {
        module: (*module).into(),
        path: (*module).into(),
        text: (*text).into(),
    };
    House::new(&all.iter().map(source).collect::<Vec<_>>())
}

/// What is wrong with the paths of the first of `modules`.
fn wrong(modules: &[(&str, &str)]) -> Vec<String> {
    let house = house(modules);
    breaches(&house, &house.files[0])
}

#[test]
fn forged_breaches_are_caught() {
    for (module, text) in [
        ("hairpin::world::sample", "use crate::robot::quadrotor::Quadrotor;"),
        ("hairpin::math::random", "use crate::{world::World};"),
        ("hairpin::trajectory::track", "fn f(w: &crate::world::World) {}"),
        ("hairpin::simulation::plant", "use crate::{math::random, feasibility::{self, reach::Leg}};"),
        ("hairpin::feasibility::limits", "use crate::simulation as s;"),
        ("hairpin::judgement::measure", "pub use crate :: robot :: quadrotor :: Quadrotor;"),
        ("hairpin::judgement", "use super::simulation::plant;"),
        ("hairpin::judgement::tests", "mod deep { use super::super::super::campaign; }"),
        ("hairpin::search::beam", "use crate::world::World;"),
        ("hairpin::search::beam", "use super::exact::triples;"),
        ("hairpin::search::beam::frontier", "use crate::search::exact;"),
        ("hairpin::verification::replay", "use crate::math::integrate::rk4;"),
        ("hairpin::verification::replay", "use crate::math::{random, integrate::rk4};"),
        ("hairpin::verification::replay", "let f = crate::robot::quadrotor::Quadrotor::derivative;"),
        ("hairpin::verification::replay", "use crate::feasibility::*;"),
        ("hairpin::verification::replay", "use crate::search::beam;"),
        ("hairpin::feasibility::reach::witness", "use super::hull::Polytope;"),
        ("hairpin::feasibility::reach::witness", "use self::super::sphere;"),
        ("hairpin::simulation::controllers::anafi", "use crate::simulation::controllers::geometric::Gains;"),
        ("hairpin::campaign::flight::solve", "use crate::campaign::drive::Site;"),
        ("hairpin::robot::ground::car", "use super::differential_drive::DifferentialDrive;"),
        ("hairpin::campaign::generate", "fn f() { println!(\"done\") }"),
        ("hairpin::campaign::generate", "use std::{fmt, time::Instant};"),
        ("hairpin::campaign::generate", "let text = std::fs::read_to_string(path);"),
        ("hairpin::campaign::generate", "#[cfg(test)] mod tests { fn f() {} } use std::env;"),
        ("hairpin::campaign::generate", "#[cfg(feature = \"unit-tests\")] mod tests { fn f() {} } use std::env;"),
        ("hairpin::campaign::generate", "#[cfg(feature = \"other\")] mod more { use std::env; }"),
        ("hairpin::math::rotation", "let (s, c) = (0.5 * roll).sin_cos();"),
        ("hairpin::math::rotation", "let y = 2.0.powi(3);"),
        ("hairpin::feasibility::reach::sampling", "all.map(f64::exp)"),
        ("hairpin::feasibility::reach::witness", "let turn = incoming .angle(&outgoing);"),
        ("hairpin::feasibility::steering::flatness", "let q = UnitQuaternion::from_euler_angles(roll, pitch, 0.0);"),
        ("hairpin::judgement::statistics", "use statrs::function::beta::beta_reg;"),
        ("hairpin_formats::csv", "use crate::tum::write;"),
        ("hairpin_formats::parquet::track", "use hairpin::search::Beam;"),
        ("hairpin_formats::parquet::track", "use ::hairpin::{trajectory::Track, simulation};"),
        ("hairpin_formats::folder", "use hairpin_jobs::generate;"),
        ("hairpin_jobs::generate", "fn f() { hairpin_lab::bench::run() }"),
        ("hairpin_jobs::generate", "use clap::Parser;"),
        ("hairpin_jobs::generate", "fn f() { println!(\"done\") }"),
        ("hairpin_jobs::generate", "let bar = indicatif::ProgressBar::new(3);"),
        ("hairpin_jobs::generate", "use std::{fmt, io::{self, stdout}};"),
        ("hairpin_lab::bench", "use hairpin_cli::console;"),
        ("hairpin_lab::bench", "use ctrlc::set_handler;"),
    ] {
        assert!(!wrong(&[(module, text)]).is_empty(), "not caught in {module}: {text}");
    }
}

#[test]
fn what_is_allowed_passes() {
    for (module, text) in [
        ("hairpin::world::sample", "use crate::math::random::stream; use super::World;"),
        ("hairpin::world::tests", "//! like crate::robot::x\n/// [`crate::robot`] /* crate::robot */"),
        ("hairpin::math::random", "const A: &str = \"crate::world::x\"; const B: &str = r#\"use crate::world;\"#;"),
        ("hairpin::math::random", "fn f<'a>(c: &'a char) -> bool { *c == '\"' } // crate::world"),
        ("hairpin::math", "mod tests { use super::*; } pub mod random; pub(crate) use random::stream;"),
        ("hairpin::verification::replay", "use crate::math::random; use super::body::Body;"),
        ("hairpin::feasibility::reach", "pub mod hull; pub mod witness; pub use self::hull::Hull;"),
        ("hairpin::feasibility::reach::hull", "use crate::feasibility::polytope::Polytope; use super::Reach;"),
        ("hairpin::campaign::generate", "#[cfg(test)] mod tests { use std::time::Instant; } use crate::search::beam;"),
        ("hairpin::campaign::generate::tests", "use std::time::Instant;"),
        ("hairpin::math::rotation", "let s = libm::sin(x).sqrt(); let z = Self { sin, ..exp() }; // x.sin()"),
        ("hairpin::math::rotation", "#[cfg(test)] mod tests { fn f(x: f64) -> f64 { x.sin() } }"),
        ("hairpin::math::rotation", "#[cfg(feature = \"unit-tests\")] mod tests { fn f(x: f64) -> f64 { x.sin() } }"),
        ("hairpin::campaign::report::solid", "let x = angle.cos();"),
        ("hairpin_formats::folder", "use crate::{csv, tum}; use hairpin::campaign::Case; use std::fs;"),
        (
            "hairpin_jobs::generate",
            "use hairpin_formats::folder; use std::io::Write; #[test] fn f() { println!(\"\") }",
        ),
        ("hairpin_cli::commands::generate", "use clap::Parser; use hairpin_jobs::generate; fn f() { println!(\"\") }"),
    ] {
        let found = wrong(&[(module, text)]);
        assert!(found.is_empty(), "{found:?}");
    }
}

/// A way around a floor: what stands above exports what is hidden, under the same name or another.
#[test]
fn exports_are_followed() {
    let hidden = ("hairpin::feasibility::reach", "pub struct Leg; pub fn legs() {}");
    for (face, text) in [
        ("pub use crate::feasibility::reach::Leg;", "use hairpin::campaign::face::Leg;"),
        ("pub use crate::feasibility::reach::Leg as Step;", "fn f(step: hairpin::campaign::face::Step) {}"),
        ("pub use crate::feasibility::reach::*;", "fn f() { hairpin::campaign::face::legs() }"),
        ("pub use crate::feasibility::reach;", "use hairpin::campaign::face::reach::Leg;"),
        (
            "use crate::feasibility as f; pub use f::reach::{self as r}; pub use r::Leg;",
            "use hairpin::campaign::face::*; fn f(leg: Leg) {}",
        ),
        (
            "mod deep { pub use super::super::super::feasibility::reach::Leg; } pub use deep::Leg;",
            "use hairpin::campaign::{face}; fn f(leg: face::Leg) {}",
        ),
    ] {
        let modules = [("hairpin_formats::csv", text), ("hairpin::campaign::face", face), hidden];
        assert!(!wrong(&modules).is_empty(), "not caught: {text} through {face}");
        let all = house(&modules);
        assert!(!floors::hidden(&all, &all.files[1]).is_empty(), "exported: {face}");
    }
    for (face, text) in [
        ("use crate::feasibility::reach::Leg; pub struct Kept(Leg);", "use hairpin::campaign::face::Kept;"),
        (
            "pub struct Leg; mod inner { pub struct Foot; } pub use inner::Foot;",
            "use hairpin::campaign::face::{Foot, Leg};",
        ),
        ("pub use nalgebra::Vector3;", "use hairpin::campaign::face::Vector3;"),
        (
            "pub type Legs = Vec<u8>; #[cfg(test)] pub use crate::feasibility::reach::Leg;",
            "use hairpin::campaign::face::Legs;",
        ),
    ] {
        let modules = [("hairpin_formats::csv", text), ("hairpin::campaign::face", face), hidden];
        let all = house(&modules);
        assert_eq!(wrong(&modules), Vec::<String>::new(), "{text} through {face}");
        assert_eq!(floors::hidden(&all, &all.files[1]), Vec::<String>::new(), "{face}");
    }
    let alias = house(&[("hairpin::campaign::face", "pub type Step = crate::feasibility::reach::Leg;"), hidden]);
    assert_eq!(floors::hidden(&alias, &alias.files[0]).len(), 1, "another name");
    let face = house(&[
        ("hairpin::campaign", "mod inner; pub use inner::Foot;"),
        ("hairpin::campaign::inner", "pub struct Foot;"),
    ]);
    assert_eq!(floors::hidden(&face, &face.files[0]), Vec::<String>::new(), "a face exports what is behind it");
}

#[test]
fn manifests_are_read() {
    let wrong = |text: &str| floors::wrong_dependencies("hairpin_jobs", text).len();
    assert_eq!(
        wrong(
            "[package]\nname = \"hairpin-jobs\"\n[dependencies]\nclap.workspace = true\nhairpin-cli = { path = \"\" }\n"
        ),
        2
    );
    assert_eq!(
        wrong("[dependencies]\nhairpin.workspace = true\nserde = \"1\"\n\n[dev-dependencies]\nclap.workspace = true\n"),
        0
    );
}

#[test]
fn circles_are_found_through_faces() {
    let face = ("hairpin::world", "mod a; mod b; mod c; pub use a::A; pub use b::*; pub use c::C;");
    let c = ("hairpin::world::c", "pub struct C;");
    let found = |a: &str, b: &str| {
        let house = house(&[face, ("hairpin::world::a", a), ("hairpin::world::b", b), c]);
        circles(&needs(&house)).into_iter().map(|circle| circle.into_iter().collect()).collect::<Vec<Vec<usize>>>()
    };
    let b = "use crate::world::A; pub struct B(A);";
    for a in [
        "use super::B; pub struct A;",
        "pub struct A; impl A { fn f() { crate::world::B::new() } }",
        "use super::*; pub struct A; fn f(b: B) {}",
        "use super::super::world as w; pub struct A; fn f() -> w::B { loop {} }",
        "pub struct A; fn f() { use super::b::B; B::new() }",
    ] {
        assert_eq!(found(a, b), [[1, 2]], "not found: {a}");
    }
    for a in [
        "use super::C; pub struct A;",
        "pub struct A; #[cfg(test)] mod tests { use super::super::B; }",
        "pub struct A; #[cfg(test)] use super::B;",
        "pub struct A; // crate::world::B\nconst B: &str = \"crate::world::B\";",
        "use super::*; pub struct A; struct B; fn f(b: B) {}",
    ] {
        assert_eq!(found(a, b), Vec::<Vec<usize>>::new(), "found: {a}");
    }
    let holding = house(&[
        ("hairpin::world", "mod a; pub use a::A; pub struct World(A);"),
        ("hairpin::world::a", "use super::World; pub struct A;"),
    ]);
    assert_eq!(circles(&needs(&holding)).len(), 1, "what holds something is no face");
}

#[test]
fn the_rooms_of_campaign_are_held_to_their_floors() {
    let face = ("hairpin::campaign", "pub mod case; pub mod judge; pub use case::Case; pub use judge::judge;");
    let found = |case: &str, judge: &str| {
        let house = house(&[
            face,
            ("hairpin::campaign::case", case),
            ("hairpin::campaign::judge", judge),
            ("hairpin::campaign::mission", "pub struct Mission;"),
        ]);
        campaign::breaches(&house, &needs(&house)).len()
    };
    assert_eq!(found("pub struct Case;", "use super::Case; pub fn judge(case: Case) {}"), 0);
    assert_eq!(found("use super::judge; pub struct Case; fn f() { judge() }", "pub fn judge() {}"), 1, "upward");
    assert_eq!(found("pub struct Case;", "use super::mission::Mission; pub fn judge() {}"), 1, "sideways");
    assert_eq!(found("#[cfg(test)] mod tests { use super::super::judge; } pub struct Case;", "pub fn judge() {}"), 0);
}

#[test]
fn wide_comments_are_found() {
    let wide = "x".repeat(120);
    assert_eq!(
        width::too_long(&format!("// {wide}\nlet a = \"{wide}\";\nlet b = 1; // {wide}\n/* a\n{wide}y */\n/// ok\n")),
        [1, 3, 5]
    );
    assert_eq!(width::too_long(&format!("//{}\nlet a = \"// {wide}\";\n", &wide[2..])), Vec::<usize>::new());
}

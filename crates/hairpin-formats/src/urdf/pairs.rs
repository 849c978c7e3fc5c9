//! Pairs of links that are not held against each other.

use std::collections::BTreeSet;

use hairpin::robot::arm::APART;

use super::element::{UrdfError, told};
use super::stand::Stand;
use super::tip::AXES;

/// Pairs of the arm's links, and the tool (7), that are left out: those of which every pair of links with a body is
/// `disabled`, and those that were `asked` for by name or by what findings call them.
///
/// # Errors
/// A name that none is called.
pub(super) fn left_out(
    stands: &[(&str, Stand)],
    (tip, has_body): (&str, &dyn Fn(&str) -> bool),
    disabled: &[[String; 2]],
    asked: &[[String; 2]],
) -> Result<Vec<[usize; 2]>, UrdfError> {
    let mut pairs = Vec::new();
    for [a, b] in asked {
        let (a, b) = (number(stands, a)?, number(stands, b)?);
        if a != b {
            pairs.push([a.min(b), a.max(b)]);
        }
    }
    let mut members: [Vec<&str>; AXES + 2] = Default::default();
    members[AXES + 1].push(tip);
    for (name, stand) in stands {
        // A frame has no body and need not be named; a link of which nothing is described has its stand-in.
        if has_body(name) {
            members[stand.of].push(name);
        }
    }
    for (of, links) in members.iter_mut().enumerate().filter(|(_, links)| links.is_empty()) {
        links.extend(stands.iter().filter(|(_, stand)| stand.of == of && stand.on_way).map(|(name, _)| *name).take(1));
    }
    let pair = |[a, b]: &[String; 2]| if a <= b { [a.clone(), b.clone()] } else { [b.clone(), a.clone()] };
    let disabled: BTreeSet<[String; 2]> = disabled.iter().map(pair).collect();
    let is_disabled = |a: &str, b: &str| disabled.contains(&pair(&[a.to_owned(), b.to_owned()]));
    let every = |a: &[&str], b: &[&str]| a.iter().all(|a| b.iter().all(|b| is_disabled(a, b)));
    for low in 0..=AXES {
        for high in low + APART..AXES + 2 {
            if every(&members[low], &members[high]) {
                pairs.push([low, high]);
            }
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    Ok(pairs)
}

/// 0 the base, 1 to 6 the links, 7 the tool.
fn number(stands: &[(&str, Stand)], name: &str) -> Result<usize, UrdfError> {
    let of_link = stands.iter().find(|(link, _)| *link == name).map(|(_, stand)| stand.of);
    let in_words = || match name.strip_prefix("the ").unwrap_or(name) {
        "base" => Some(0),
        "tool" => Some(AXES + 1),
        other => other.strip_prefix("link ").unwrap_or(other).parse().ok().filter(|number| *number <= AXES + 1),
    };
    of_link.or_else(in_words).ok_or_else(|| {
        UrdfError::Chain(format!("exclude: \"{}\" is no link, nor `base`, `link 1` to `link 6`, `tool`", told(name)))
    })
}

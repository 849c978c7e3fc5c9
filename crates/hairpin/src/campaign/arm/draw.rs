//! Programs drawn at random among those that are possible.

use super::program::Met;
use super::ways::{Place, Standing, Ways};
use crate::math::random::{Stream, unit};
use crate::search::{NoWalk, stroll};

/// Moves tried, by those that a program has, before a walk is given up.
const TRIED: u64 = 500;

impl Ways<'_> {
    /// A way through `length` points from home and back.
    ///
    /// A random walk: from home, and from every point, each point that a move leads to from there (in each of its
    /// postures, and as often as visits allow) is the next one alike; where that leads no further, the walk takes it
    /// back. Where every move is possible all orders of all choices of so many points come alike; else ways through
    /// points with few moves come more often. Where arcs are possible, each point from the first on that one can pass
    /// is passed by it in half of all draws. Speeds and zones are drawn from the scenario's lists.
    ///
    /// # Errors
    /// Why there is none, in a sentence's part.
    pub(super) fn drawn(&self, length: usize, random: &mut Stream) -> Result<Vec<Met>, String> {
        let most = TRIED * (length as u64 + 1);
        let next = |walk: &[Place]| self.next(walk, length);
        let step = |from: &Place, to: &Place| self.leads(*from, *to);
        let walk = stroll(Place::Home, length + 2, next, step, most, random).map_err(|none| match none {
            NoWalk::None => "there is no way of so many points".to_owned(),
            NoWalk::Asked(most) => format!("none was found in {most} moves"),
        })?;
        let at = |place: &Place| if let Place::At(at) = place { Some(*at) } else { None };
        let standings: Vec<Standing> = walk.iter().filter_map(at).collect();
        let mut passed = vec![false; standings.len()];
        for k in 1..standings.len().saturating_sub(1) {
            let triple = [standings[k - 1], standings[k], standings[k + 1]];
            passed[k] = !passed[k - 1] && self.has_arc(triple) && unit(random) < 0.5;
        }
        let moves = self.setup.drawn_moves(standings.len(), random);
        let met = |((at, (speed, zone)), passed): ((&Standing, _), bool)| Met {
            row: at.row,
            configuration: self.configuration(*at),
            speed,
            zone,
            passed,
        };
        Ok(standings.iter().zip(moves).zip(passed).map(met).collect())
    }

    /// Where a walk from home may go on to, as far as nothing need be followed to know.
    ///
    /// `walk` holds home and the points so far. The candidates are all standings of rows that are free: not at the
    /// fixed start's or end's turn unless it is that row, fewer than `visits` times used, the move not used before,
    /// the branch unchanged where moves are straight. O(rows · postures · walk).
    fn next(&self, walk: &[Place], length: usize) -> Vec<Place> {
        if walk.len() == length + 1 {
            return vec![Place::Home];
        }
        let search = &self.setup.scenario.generate.search;
        let (is_first, is_last) = (walk.len() == 1, walk.len() == length);
        let fixed =
            |wanted: Option<u64>, here: bool, row: usize| !here || wanted.is_none_or(|wanted| wanted as usize == row);
        let came = |row: usize| walk.iter().filter(|place| matches!(place, Place::At(at) if at.row == row)).count();
        let rows = (0..self.points()).filter(|row| {
            fixed(search.start, is_first, *row)
                && fixed(search.end, is_last, *row)
                && (came(*row) as u64) < search.visits
        });
        let last = walk.last().copied();
        let may_follow = |to: &Standing| match last {
            Some(Place::At(from)) => from.row != to.row && self.may_follow(from, *to) && !self.is_used(walk, from, *to),
            _ => true,
        };
        // Not by what was followed so far: a draw depends on nothing that was drawn before.
        let may_lead = |to: &Place| last.is_none_or(|from| self.of_graph(from, *to) != Some(false));
        let to = rows.flat_map(|row| self.standings(row)).filter(may_follow).map(Place::At);
        to.filter(may_lead).collect()
    }

    /// Whether a walk has the move from one point to another already: points may come twice, moves once.
    fn is_used(&self, walk: &[Place], from: Standing, to: Standing) -> bool {
        let row = |place: &Place| if let Place::At(at) = place { Some(at.row) } else { None };
        let visits = self.setup.scenario.generate.search.visits;
        visits > 1 && walk.windows(2).any(|pair| (row(&pair[0]), row(&pair[1])) == (Some(from.row), Some(to.row)))
    }
}

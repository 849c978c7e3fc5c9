//! Programs made of others: points in another order, others of them, met in other postures, at other speeds, with other
//! zones; and the beginning of one with the rest of another.

use std::collections::HashSet;

use super::program::Met;
use super::ways::{Place, Standing, Ways};
use crate::math::random::{Stream, unit};
use crate::trajectory::program::{Speed, Zone};

/// Changes that are drawn before one is given up: most orders are not possible where much is in the way.
const TRIES: usize = 16;
/// Share of the changes that are made where they are asked for; the others are made anywhere.
const THERE: f64 = 0.75;

/// What is changed at a point of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Change {
    /// The points from it to another one, in the reverse order.
    Reverse,
    /// It is met earlier or later.
    Shift,
    /// It changes places with another one.
    Swap,
    /// Another point in its place.
    Exchange,
    /// The speed of the move to it.
    Speed,
    /// The zone of that move.
    Zone,
    /// How the arm stands at it; of straight moves at all points.
    Configuration,
    /// Whether an arc passes it.
    Arc,
}

/// One of 0 … n − 1, all alike; 0 for n = 0.
fn below(n: usize, random: &mut Stream) -> usize {
    ((unit(random) * n as f64) as usize).min(n.saturating_sub(1))
}

/// One of `all`.
fn one_of<T: Copy>(all: &[T], random: &mut Stream) -> Option<T> {
    all.get(below(all.len(), random)).copied()
}

impl Ways<'_> {
    /// `way` with one change, mostly at an end of leg number `leg`; `None` where none of 16 that were drawn is
    /// possible.
    pub(super) fn altered(&self, way: &[Met], leg: usize, random: &mut Stream) -> Option<Vec<Met>> {
        let changes = self.changes(way.len());
        (0..TRIES).find_map(|_| {
            let change = one_of(&changes, random)?;
            let there = unit(random) < THERE;
            let place = if there { place_of(way, leg, random)? } else { below(way.len(), random) };
            let mut child = way.to_vec();
            self.change(&mut child, place, change, random)?;
            let child = self.mended(child);
            (child != way && self.is_possible(&child)).then_some(child)
        })
    }

    /// The points of `way` up to where leg number `leg` leads, and then those of `other` in its order that have not
    /// come as often as they may, until there are as many as `way` has; each as its parent meets it. Where that is not
    /// possible the cut is tried before and after.
    pub(super) fn crossed(&self, way: &[Met], other: &[Met], leg: usize, random: &mut Stream) -> Option<Vec<Met>> {
        let middle = place_of(way, leg, random)? + 1;
        let visits = self.setup.scenario.generate.search.visits as usize;
        (0..TRIES).find_map(|k| {
            // 0, 1, −1, 2, −2, …
            let off = if k % 2 == 1 { (k as isize + 1) / 2 } else { -(k as isize / 2) };
            let cut = middle.checked_add_signed(off).filter(|cut| (1..way.len()).contains(cut))?;
            let mut child = way[..cut].to_vec();
            for met in other {
                let came = child.iter().filter(|passed| passed.row == met.row).count();
                if child.len() == way.len() {
                    break;
                }
                if came < visits {
                    child.push(self.in_branch_of(&child[0], met)?);
                }
            }
            let child = self.mended(child);
            (child.len() == way.len() && child != way && self.is_possible(&child)).then_some(child)
        })
    }

    /// What may be changed of a program of so many points.
    fn changes(&self, points: usize) -> Vec<Change> {
        let moves = &self.setup.scenario.generate.moves;
        let visits = self.setup.scenario.generate.search.visits as usize;
        [
            (points > 1, Change::Reverse),
            (points > 1, Change::Shift),
            (points > 1, Change::Swap),
            (visits > 1 || points < self.points(), Change::Exchange),
            (moves.speeds.len() > 1, Change::Speed),
            (moves.zones.len() > 1, Change::Zone),
            (self.has_choice(), Change::Configuration),
            (self.graph.arcs.is_some(), Change::Arc),
        ]
        .into_iter()
        .filter_map(|(may, change)| may.then_some(change))
        .collect()
    }

    /// Makes `change` at `place`; `None` where there is nothing to change it to.
    fn change(&self, way: &mut Vec<Met>, place: usize, change: Change, random: &mut Stream) -> Option<()> {
        let other = below(way.len(), random);
        let moves = &self.setup.scenario.generate.moves;
        match change {
            Change::Reverse => way[place.min(other)..=place.max(other)].reverse(),
            Change::Shift => {
                let met = way.remove(place);
                way.insert(other, met);
            }
            Change::Swap => way.swap(place, other),
            Change::Exchange => {
                let visits = self.setup.scenario.generate.search.visits as usize;
                let free = |row: &usize| way.iter().filter(|met| met.row == *row).count() < visits;
                let rows: Vec<usize> = (0..self.points()).filter(|row| *row != way[place].row && free(row)).collect();
                let row = one_of(&rows, random)?;
                let like = self.standing(&way[place])?;
                let standings: Vec<Standing> = self.standings(row).filter(|at| self.may_follow(like, *at)).collect();
                let at = one_of(&standings, random)?;
                (way[place].row, way[place].configuration) = (row, self.configuration(at));
            }
            Change::Speed => {
                let named = moves.speeds.iter().filter_map(|name| Speed::predefined(name));
                let others: Vec<Speed> = named.filter(|speed| !speed.same_as(&way[place].speed)).collect();
                way[place].speed = others.get(below(others.len(), random))?.clone();
            }
            Change::Zone => {
                let named = moves.zones.iter().filter_map(|name| Zone::predefined(name));
                let others: Vec<Zone> = named.filter(|zone| !zone.same_as(&way[place].zone)).collect();
                way[place].zone = others.get(below(others.len(), random))?.clone();
            }
            Change::Configuration => self.stand_otherwise(way, place, random)?,
            Change::Arc => {
                way[place].passed = !way[place].passed;
                // No two beside each other: the one that is asked for counts.
                if way[place].passed {
                    let beside = [place.checked_sub(1), Some(place + 1)].into_iter().flatten();
                    beside.filter(|k| *k < way.len()).collect::<Vec<_>>().iter().for_each(|k| way[*k].passed = false);
                }
            }
        }
        Some(())
    }

    /// Another posture at `place`, and where moves are straight at all points that then must have it, too.
    fn stand_otherwise(&self, way: &mut [Met], place: usize, random: &mut Stream) -> Option<()> {
        let now = self.standing(&way[place])?;
        let others: Vec<Standing> = self.standings(now.row).filter(|at| *at != now).collect();
        let at = one_of(&others, random)?;
        way[place].configuration = self.configuration(at);
        if !self.may_follow(now, at) {
            let first = way[place].clone();
            for met in way.iter_mut() {
                *met = self.in_branch_of(&first, met)?;
            }
        }
        Some(())
    }

    /// `met` as it can follow `first`: where moves are straight in its branch; `None` where there is no such posture.
    fn in_branch_of(&self, first: &Met, met: &Met) -> Option<Met> {
        let (first, own) = (self.standing(first)?, self.standing(met)?);
        if self.may_follow(first, own) {
            return Some(met.clone());
        }
        let at = self.standings(met.row).find(|at| self.may_follow(first, *at))?;
        Some(Met { configuration: self.configuration(at), ..met.clone() })
    }

    /// `way` without the arcs that its order does not have any more.
    ///
    /// Where an arc's three points are no arc of the graph any more, or two passed points stand side by side, the
    /// point is met by straight moves instead. Whether these are possible is asked afterwards.
    fn mended(&self, mut way: Vec<Met>) -> Vec<Met> {
        for k in 0..way.len() {
            let standings =
                || Some([self.standing(&way[k - 1])?, self.standing(&way[k])?, self.standing(&way[k + 1])?]);
            let inside = k > 0 && k + 1 < way.len();
            way[k].passed &= inside && !way[k - 1].passed && standings().is_some_and(|triple| self.has_arc(triple));
        }
        way
    }

    /// Whether `way` leads from home to home: every move is possible and comes once, no point comes too often, and the
    /// ends are those that are asked for.
    ///
    /// O(points²) for the counts, and one question of the graph or one followed move a leg.
    pub(super) fn is_possible(&self, way: &[Met]) -> bool {
        let search = &self.setup.scenario.generate.search;
        let (Some(first), Some(last)) = (way.first(), way.last()) else { return false };
        let fixed = |wanted: Option<u64>, met: &Met| wanted.is_none_or(|row| row as usize == met.row);
        let often = |met: &Met| way.iter().filter(|other| other.row == met.row).count() as u64 <= search.visits;
        if !fixed(search.start, first) || !fixed(search.end, last) || !way.iter().all(often) {
            return false;
        }
        let Some(standings) = way.iter().map(|met| self.standing(met)).collect::<Option<Vec<_>>>() else {
            return false;
        };
        let mut moves = HashSet::new();
        let between = (1..way.len()).all(|k| {
            let (from, to) = (standings[k - 1], standings[k]);
            // An arc leads over the point that it passes.
            let arc = way[k].passed || way[k - 1].passed;
            let leads = arc || self.leads(Place::At(from), Place::At(to));
            leads && moves.insert((from.row, to.row))
        });
        let arcs = (0..way.len()).filter(|k| way[*k].passed).all(|k| {
            let inside = k > 0 && k + 1 < way.len();
            inside && !way[k + 1].passed && self.has_arc([standings[k - 1], standings[k], standings[k + 1]])
        });
        let home = |at: &Standing, leaves: bool| match leaves {
            true => self.leads(Place::Home, Place::At(*at)),
            false => self.leads(Place::At(*at), Place::Home),
        };
        between && arcs && home(&standings[0], true) && home(&standings[standings.len() - 1], false)
    }
}

/// The place of a point that leg number `leg` leads to, or comes from: legs lead from home to where moves end, and
/// home.
///
/// Arcs make legs and points differ: a point that an arc passes ends no move, so leg k leads to the k-th of the points
/// that are not passed. The first or the second of a leg's two ends is taken with even odds; numbers beyond the last
/// end are the last. `None` of a way without an end.
fn place_of(way: &[Met], leg: usize, random: &mut Stream) -> Option<usize> {
    let ends: Vec<usize> = (0..way.len()).filter(|k| !way[*k].passed).collect();
    let comes_from = unit(random) < 0.5;
    let number = if comes_from { leg.saturating_sub(1) } else { leg };
    ends.get(number.min(ends.len().checked_sub(1)?)).copied()
}

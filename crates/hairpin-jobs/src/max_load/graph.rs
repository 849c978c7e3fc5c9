//! The graph that was asked about, in the unit of its file.

use std::path::Path;

use hairpin::search::heaviest::{Arcs, ArcsMistake, WalkMistake};
use hairpin_formats::costs::{self, Costs};
use serde_json::Value;

use crate::Problem;

/// Costs as whole numbers, and what they stand for.
pub struct Graph {
    /// The arcs with their costs.
    pub arcs: Arcs,
    costs: Costs,
}

impl Graph {
    /// Reads a table of costs.
    ///
    /// # Errors
    /// The file cannot be read, or is none.
    pub fn read(path: &Path) -> Result<Self, Problem> {
        let costs = costs::read(path).map_err(|error| match error.entry() {
            Some((at, bound)) => Problem::Entry { sentence: error.to_string(), at, bound },
            None => Problem::input(error),
        })?;
        let arcs = Arcs::new(costs.points, &costs.costs);
        let arcs = arcs.map_err(|mistake| match in_its_unit(&costs, &mistake) {
            Problem::Entry { sentence, at, bound } => {
                Problem::Entry { sentence: format!("{}: {sentence}", path.display()), at, bound }
            }
            other => Problem::of_file(path, other),
        })?;
        Ok(Self { arcs, costs })
    }

    /// What is wrong with a question of points that come several times.
    pub(super) fn refused(&self, mistake: &WalkMistake) -> Problem {
        match mistake {
            WalkMistake::Arcs(mistake) => in_its_unit(&self.costs, mistake),
            WalkMistake::Visits { .. } => Problem::input(mistake),
        }
    }

    /// The power of ten that makes all costs whole.
    pub fn scale(&self) -> i64 {
        self.costs.scale()
    }

    /// A cost as people read it.
    pub fn text(&self, cost: i64) -> String {
        self.costs.text(cost)
    }

    /// A cost as machines read it.
    pub fn value(&self, cost: i64) -> Value {
        if self.scale() == 1 {
            return cost.into();
        }
        // The nearest number: JSON readers have no decimals.
        self.text(cost).parse::<f64>().map_or(Value::Null, Value::from)
    }

    /// The smallest whole cost that is at least `text`.
    pub(super) fn at_least(&self, text: &str) -> Result<i64, Problem> {
        let least = self.costs.at_least(text);
        least.ok_or_else(|| Problem::input(format!("--min-cost `{text}`, must be a decimal number ≥ 0 within 64 bits")))
    }
}

/// A mistake with the cost as it stands in its file, and what gives it room.
fn in_its_unit(costs: &Costs, mistake: &ArcsMistake) -> Problem {
    let ArcsMistake::Overflow { from, to, cost, bound, points } = *mistake else { return Problem::input(mistake) };
    let (line, column) = (from + 1, to + 1);
    let [cost, most] = [cost, bound].map(|whole| costs.text(whole));
    let way = match decimals_within(costs, bound) {
        Some(decimals) => format!("with {} decimals; rounded to {decimals} all costs are", costs.decimals),
        None => "in whole numbers; in a coarser unit all costs are".to_owned(),
    };
    let bound = format!("at most {most} for sums over {points} points to be exact {way}");
    let sentence = format!("line {line}, column {column}: cost {cost} of the arc {from}→{to}, must be {bound}");
    Problem::Entry { sentence, at: [line, column], bound }
}

/// The most decimals with which no cost, rounded, is more than `bound` whole numbers.
fn decimals_within(costs: &Costs, bound: i64) -> Option<usize> {
    let largest = costs.costs.iter().flatten().max()?;
    (0..costs.decimals).rev().find(|decimals| largest / 10i64.pow((costs.decimals - decimals) as u32) < bound)
}

#[cfg(test)]
mod tests {
    use crate::Unwatched;
    use crate::max_load::{MaxLoadSettings, max_load};

    /// As Python writes 158.01 + 0.01 and 9.699…: the digits that make a double.
    #[test]
    fn costs_without_room_are_told_as_they_stand_with_the_decimals_that_have_it() {
        let place = tempfile::tempdir().unwrap();
        let graph = place.path().join("costs.csv");
        let refused = |text: &str, visits: usize| {
            std::fs::write(&graph, text).unwrap();
            let settings = MaxLoadSettings { graph: graph.clone(), visits, ..MaxLoadSettings::default() };
            max_load(&settings, &Unwatched).err().map(|problem| problem.to_string())
        };
        for (text, visits, at, bound, way) in [
            (
                ",9.699254132161325\n158.019999999999996,\n",
                1,
                "line 2, column 1: cost 158.0",
                "72.057594037927935",
                "14",
            ),
            (",9.699254132161325\n58.019999999999996,\n", 2, "line 2, column 1: cost 58.0", "36.028797018963967", "14"),
            (",7.000000000000000001\n3,\n", 1, "line 1, column 2: cost 7.000000000000000001 ", "0.0720", "16"),
        ] {
            let said = refused(text, visits).unwrap();
            let words = [at, bound, &format!("; rounded to {way} all costs are")];
            assert!(words.iter().all(|words| said.contains(*words)), "{said}");
        }
        assert!(refused(",9000000000000000000\n1,\n", 1).unwrap().contains("in a coarser unit"));
        assert_eq!(refused(",9.69925413216133\n158.02,\n", 1), None);
    }
}

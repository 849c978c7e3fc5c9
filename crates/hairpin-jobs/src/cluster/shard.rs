//! Which share of the parts a machine makes: as it was told, or as its scheduler says.

use std::fmt;
use std::str::FromStr;

use crate::Problem;

/// The share of one of `of` machines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// From 1.
    pub number: u64,
    /// How many there are.
    pub of: u64,
}

impl fmt::Display for Shard {
    fn fmt(&self, to: &mut fmt::Formatter) -> fmt::Result {
        write!(to, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("`{text}` is no shard: i/N, such as 3/8, i from 1 to N");
        let (number, of) = text.split_once('/').ok_or_else(wrong)?;
        let (number, of) = number.parse().ok().zip(of.parse().ok()).ok_or_else(wrong)?;
        if number >= 1 && number <= of { Ok(Self { number, of }) } else { Err(wrong()) }
    }
}

impl Shard {
    /// Those of `parts` parts that are its own: every N-th, so that shares differ by one at most and dear parts, which
    /// often stand side by side, are spread.
    pub(super) fn own(self, parts: u64) -> impl Iterator<Item = u64> {
        (self.number - 1..parts).step_by(usize::try_from(self.of).unwrap_or(usize::MAX))
    }
}

/// The shard that a scheduler names in the environment, of which `variable` gives the values.
///
/// | scheduler | index | number of shards |
/// | --- | --- | --- |
/// | Slurm job array | `SLURM_ARRAY_TASK_ID`, from `_MIN` in steps of `_STEP` | `SLURM_ARRAY_TASK_COUNT` |
/// | Kubernetes indexed Job | `JOB_COMPLETION_INDEX`, from 0 | `asked`, or `HAIRPIN_SHARDS` |
/// | AWS Batch array job | `AWS_BATCH_JOB_ARRAY_INDEX`, from 0 | `AWS_BATCH_JOB_ARRAY_SIZE`, or as above |
///
/// # Errors
/// None of these is there, or several are; a number that is none; an index beyond the number.
pub fn shard_from_env(asked: Option<u64>, variable: &dyn Fn(&str) -> Option<String>) -> Result<Shard, Problem> {
    let number = |name: &str| -> Result<Option<u64>, Problem> {
        let Some(text) = variable(name) else { return Ok(None) };
        let found = text.trim().parse().ok();
        found.map(Some).ok_or_else(|| Problem::input(format!("--shard from-env: {name} = {text:?} is no whole number")))
    };
    let counted = || -> Result<Option<u64>, Problem> { Ok(asked.or(number("HAIRPIN_SHARDS")?)) };
    let [slurm, kubernetes, aws] = INDICES.map(number);
    let (slurm, kubernetes, aws) = (slurm?, kubernetes?, aws?);
    let (from_zero, of, index_name, count_name) = match (slurm, kubernetes, aws) {
        (Some(id), None, None) => {
            let (first, step) = (number("SLURM_ARRAY_TASK_MIN")?, number("SLURM_ARRAY_TASK_STEP")?);
            let (first, step) = (first.unwrap_or(0), step.unwrap_or(1).max(1));
            let of = number("SLURM_ARRAY_TASK_COUNT")?;
            let regular = id >= first && (id - first) % step == 0;
            let last = number("SLURM_ARRAY_TASK_MAX")?.zip(of);
            let as_counted = last.is_none_or(|(last, of)| of > 0 && last >= first && (last - first) / step == of - 1);
            if asked.is_none() && !(regular && as_counted) {
                return Err(Problem::input(
                    "--shard from-env: the job array is no range in equal steps (`--array=0-15`, `--array=1-31:2`), so \
                     that its tasks cannot be counted: give --shard i/N, or --shards N with an array that begins with 0",
                ));
            }
            let index = if asked.is_some() { id } else { (id - first) / step };
            (index, asked.or(of), INDICES[0], "SLURM_ARRAY_TASK_COUNT")
        }
        (None, Some(index), None) => (index, counted()?, INDICES[1], "HAIRPIN_SHARDS"),
        (None, None, Some(index)) => {
            let size = number("AWS_BATCH_JOB_ARRAY_SIZE")?;
            (index, asked.or(size).or(counted()?), INDICES[2], "AWS_BATCH_JOB_ARRAY_SIZE")
        }
        (None, None, None) => {
            return Err(Problem::input(format!(
                "--shard from-env: none of {} is set: this is no task of an array; give --shard i/N",
                INDICES.join(", ")
            )));
        }
        _ => {
            let set = INDICES.into_iter().filter(|name| variable(name).is_some());
            let set: Vec<&str> = set.collect();
            return Err(Problem::input(format!(
                "--shard from-env: {} are set, and each says something else: give --shard i/N",
                set.join(" and ")
            )));
        }
    };
    let Some(of) = of else {
        return Err(Problem::input(format!(
            "--shard from-env: {index_name} says which shard this is, and nothing of how many: set {count_name}, or give --shards N"
        )));
    };
    if from_zero >= of {
        return Err(Problem::input(format!(
            "--shard from-env: {index_name} is index {from_zero}, counted from 0, of {of} shards: it must be below {of}"
        )));
    }
    Ok(Shard { number: from_zero + 1, of })
}

/// The variables that name a task.
const INDICES: [&str; 3] = ["SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX", "AWS_BATCH_JOB_ARRAY_INDEX"];

#[cfg(test)]
mod tests {
    use super::*;

    fn of(asked: Option<u64>, variables: &[(&str, &str)]) -> Result<String, String> {
        let variable = |name: &str| {
            let found = variables.iter().find(|(known, _)| *known == name);
            found.map(|(_, value)| (*value).to_owned())
        };
        shard_from_env(asked, &variable).map(|shard| shard.to_string()).map_err(|problem| problem.to_string())
    }

    fn slurm(id: &str, min: &str, max: &str, count: &str, step: &str) -> Result<String, String> {
        let names = ["ID", "MIN", "MAX", "COUNT", "STEP"].map(|end| format!("SLURM_ARRAY_TASK_{end}"));
        let values = [id, min, max, count, step];
        of(None, &names.iter().map(String::as_str).zip(values).collect::<Vec<_>>())
    }

    #[test]
    fn shards_are_counted_from_one() {
        assert_eq!("3/8".parse::<Shard>(), Ok(Shard { number: 3, of: 8 }));
        for wrong in ["0/3", "4/3", "3", "a/b", "-1/3", "1/0", "1/2/3", ""] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
        let own: Vec<Vec<u64>> = (1..=3).map(|number| Shard { number, of: 3 }.own(8).collect()).collect();
        assert_eq!(own, [vec![0, 3, 6], vec![1, 4, 7], vec![2, 5]]);
        assert_eq!(Shard { number: 5, of: 9 }.own(3).count(), 0);
    }

    #[test]
    fn schedulers_are_understood() {
        assert_eq!(slurm("7", "0", "15", "16", "1"), Ok("8/16".into()));
        assert_eq!(slurm("1", "1", "31", "16", "2"), Ok("1/16".into()));
        assert_eq!(slurm("31", "1", "31", "16", "2"), Ok("16/16".into()));
        // A list of those that failed: which of how many shards, nobody knows.
        assert!(slurm("7", "3", "12", "3", "1").unwrap_err().contains("no range"));
        let sixteen = ("SLURM_ARRAY_TASK_COUNT", "1");
        assert_eq!(of(Some(16), &[("SLURM_ARRAY_TASK_ID", "7"), sixteen]), Ok("8/16".into()));
        assert_eq!(of(Some(8), &[("JOB_COMPLETION_INDEX", "0")]), Ok("1/8".into()));
        assert_eq!(of(None, &[("JOB_COMPLETION_INDEX", "7"), ("HAIRPIN_SHARDS", "8")]), Ok("8/8".into()));
        let aws = [("AWS_BATCH_JOB_ARRAY_INDEX", "2"), ("AWS_BATCH_JOB_ARRAY_SIZE", "10")];
        assert_eq!(of(None, &aws), Ok("3/10".into()));
    }

    #[test]
    fn what_an_environment_does_not_say_is_told() {
        for (asked, variables, expected) in [
            (None, vec![], "none of SLURM_ARRAY_TASK_ID"),
            (None, vec![("JOB_COMPLETION_INDEX", "0")], "HAIRPIN_SHARDS"),
            (Some(3), vec![("JOB_COMPLETION_INDEX", "3")], "below 3"),
            (Some(3), vec![("JOB_COMPLETION_INDEX", "x")], "no whole number"),
            (Some(3), vec![("JOB_COMPLETION_INDEX", "1"), ("SLURM_ARRAY_TASK_ID", "1")], "each says something else"),
        ] {
            let told = of(asked, &variables).unwrap_err();
            assert!(told.contains(expected), "{told}");
        }
    }
}

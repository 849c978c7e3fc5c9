//! `executed.tsv`: what the executions of a search came to that was stopped, so that going on executes nothing twice.
//! A row for each: the fingerprint of what was executed, in hexadecimal digits; stress, leg and executions for each
//! target, as `0.75:4:1`, with blanks between; measures that tell it from others; `fails` of what violates something
//! whatever is limited. Of what was not carried out there is the fingerprint alone.

use std::io;
use std::str::FromStr;

use hairpin::campaign::answers::{Answer, Answers, Executed};

use super::names::EXECUTED;
use super::{CampaignFolder, FolderError};
use crate::{atomic, bounds};

/// The file has less than that, bytes: of a million executions.
const MOST: u64 = 1 << 30;

impl CampaignFolder {
    /// Writes what a search that was stopped has executed; without any there is no file.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_executed(&self, answers: Option<&Answers>) -> Result<(), FolderError> {
        let Some(answers) = answers else { return self.remove_one(EXECUTED) };
        let text: String = answers.rows().map(|(fingerprint, ran)| row(&fingerprint, ran.as_ref())).collect();
        Ok(atomic::write(&self.file(EXECUTED), text.as_bytes())?)
    }

    /// Reads that; `None` where there is none.
    ///
    /// # Errors
    /// The file is broken.
    pub fn read_executed(&self) -> Result<Option<Answers>, FolderError> {
        let path = self.file(EXECUTED);
        let refuse = |cause| FolderError::Unreadable { path: path.clone(), cause };
        let text = match bounds::read_text(&path, MOST) {
            Err(cause) if cause.kind() == io::ErrorKind::NotFound => return Ok(None),
            text => text.map_err(refuse)?,
        };
        let mut rows = Vec::new();
        for (number, line) in text.lines().enumerate() {
            let no_execution = || {
                let what = format!("line {} is no execution", number + 1);
                refuse(io::Error::new(io::ErrorKind::InvalidData, what))
            };
            rows.push(read(line).ok_or_else(no_execution)?);
        }
        Ok(Some(Answers::of_rows(rows)))
    }
}

pub(super) fn row(fingerprint: &[u8; 16], ran: Option<&Executed>) -> String {
    let name = u128::from_be_bytes(*fingerprint);
    let Some(Executed { trials, behaviour, fails }) = ran else { return format!("{name:032x}\n") };
    let trial = |(stress, leg, executions): &(f64, usize, u64)| format!("{stress}:{leg}:{executions}");
    let trials: Vec<String> = trials.iter().map(trial).collect();
    let behaviour: Vec<String> = behaviour.iter().map(f64::to_string).collect();
    let fails = if *fails { "\tfails" } else { "" };
    format!("{name:032x}\t{}\t{}{fails}\n", trials.join(" "), behaviour.join(" "))
}

pub(super) fn read(line: &str) -> Option<([u8; 16], Answer)> {
    let mut parts = line.split('\t');
    let fingerprint = u128::from_str_radix(parts.next()?, 16).ok()?.to_be_bytes();
    let (Some(trials), Some(behaviour)) = (parts.next(), parts.next()) else { return Some((fingerprint, None)) };
    let fails = match parts.next() {
        None => false,
        Some("fails") => true,
        Some(_) => return None,
    };
    let trial = |text: &str| {
        let mut of = text.split(':');
        Some((number(of.next()?)?, number(of.next()?)?, number(of.next()?)?))
    };
    let trials: Option<Vec<(f64, usize, u64)>> = trials.split_whitespace().map(trial).collect();
    let behaviour: Option<Vec<f64>> = behaviour.split_whitespace().map(number).collect();
    Some((fingerprint, Some(Executed { trials: trials?, behaviour: behaviour?, fails })))
}

fn number<T: FromStr>(text: &str) -> Option<T> {
    text.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_comes_back_to_the_bit() {
        let trial = |stress| (stress, 3, 2);
        let ran =
            Executed { trials: vec![trial(0.1 + 0.2), trial(-1e-300)], behaviour: vec![1.0 / 3.0, 0.0], fails: true };
        let fingerprint = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 255];
        assert_eq!(read(row(&fingerprint, Some(&ran)).trim_end()), Some((fingerprint, Some(ran))));
        assert_eq!(read(row(&fingerprint, None).trim_end()), Some((fingerprint, None)));
        let unmeasured = Executed { trials: vec![trial(f64::NAN)], behaviour: Vec::new(), fails: false };
        let (_, back) = read(row(&fingerprint, Some(&unmeasured)).trim_end_matches('\n')).unwrap();
        assert!(back.unwrap().trials[0].0.is_nan());
        for wrong in ["", "xyz", "00\t1:2\t", "00\t1:2:x\t", "00\t1:2:3\t1\tx"] {
            assert_eq!(read(wrong), None, "{wrong:?}");
        }
    }
}

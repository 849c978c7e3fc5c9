//! Valid inputs, spoiled byte by byte: what comes of them must be an answer or a refusal, soon and within bounds.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestError, TestRng, TestRunner};

/// Inputs of each reader where nothing else is asked for.
const USUAL: u32 = 2000;
/// No input of these sizes may take longer, even in a build without optimisation on a busy machine.
const LONGEST: Duration = Duration::from_secs(20);
/// Nor more memory at a time, bytes.
const MOST: u64 = 256 << 20;

/// What turns up in files that somebody made to break readers, or by accident.
const WORDS: [&[u8]; 24] = [
    b"nan",
    b"inf",
    b"-1",
    b"0",
    b"1e999",
    b"99999999999999999999",
    b"1e-320",
    b"\"",
    b"'",
    b"[[[[[[[[",
    b"((((((((",
    b"{{{{",
    b"]",
    b")",
    b"}",
    b",",
    b";",
    b"\n",
    b"\r\n",
    b"\0",
    b"\xff\xfe",
    b"<",
    b"&",
    b"\xe2\x80\xa8",
];

#[derive(Debug, Clone)]
pub(crate) enum Edit {
    Flip(Index, u8),
    Set(Index, u8),
    Word(Index, usize),
    Put(Index, usize),
    Remove(Index, usize),
    /// A stretch of the same input, several times over.
    Repeat(Index, usize, usize, Index),
    Cut(Index),
    /// The end of another sample.
    Splice(Index, Index, Index),
}

fn edit() -> impl Strategy<Value = Edit> {
    let at = any::<Index>;
    prop_oneof![
        3 => (at(), 0..8_u8).prop_map(|(at, bit)| Edit::Flip(at, bit)),
        3 => (at(), any::<u8>()).prop_map(|(at, byte)| Edit::Set(at, byte)),
        4 => (at(), 0..WORDS.len()).prop_map(|(at, word)| Edit::Word(at, word)),
        2 => (at(), 0..WORDS.len()).prop_map(|(at, word)| Edit::Put(at, word)),
        2 => (at(), 1..40_usize).prop_map(|(at, length)| Edit::Remove(at, length)),
        1 => (at(), 1..60_usize, 1..40_usize, at()).prop_map(|(from, length, times, to)| {
            Edit::Repeat(from, length, times, to)
        }),
        1 => at().prop_map(Edit::Cut),
        1 => (at(), at(), at()).prop_map(|(here, sample, there)| Edit::Splice(here, sample, there)),
    ]
}

/// The sample with its edits.
pub(crate) fn spoiled(samples: &[Vec<u8>], (sample, edits): &(Index, Vec<Edit>)) -> Vec<u8> {
    let mut bytes = samples[sample.index(samples.len())].clone();
    for edit in edits {
        let size = bytes.len();
        if size == 0 {
            break;
        }
        match edit {
            Edit::Flip(at, bit) => bytes[at.index(size)] ^= 1 << bit,
            Edit::Set(at, byte) => bytes[at.index(size)] = *byte,
            Edit::Word(at, word) | Edit::Put(at, word) => {
                let (at, word) = (at.index(size), WORDS[*word]);
                let over = if matches!(edit, Edit::Word(..)) { word.len() } else { 0 };
                bytes.splice(at..(at + over).min(size), word.iter().copied());
            }
            Edit::Remove(at, length) => {
                let at = at.index(size);
                bytes.drain(at..(at + length).min(size));
            }
            Edit::Repeat(from, length, times, to) => {
                let from = from.index(size);
                let stretch = bytes[from..(from + length).min(size)].repeat(*times);
                let to = to.index(size);
                bytes.splice(to..to, stretch);
            }
            Edit::Cut(at) => bytes.truncate(at.index(size)),
            Edit::Splice(here, sample, there) => {
                let other = &samples[sample.index(samples.len())];
                bytes.truncate(here.index(size));
                bytes.extend(&other[there.index(other.len().max(1)).min(other.len())..]);
            }
        }
    }
    bytes
}

/// Has `read` read spoiled `samples`: `HAIRPIN_FUZZ` says how many, `HAIRPIN_FUZZ_SEED` which. What breaks it is made
/// small and left in a file.
pub(crate) fn fuzz(name: &str, samples: &[Vec<u8>], read: impl Fn(&[u8])) {
    let number = |key: &str| std::env::var(key).ok().and_then(|text| text.parse().ok());
    let cases = number("HAIRPIN_FUZZ").map_or(USUAL, |cases: u64| cases as u32);
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&number("HAIRPIN_FUZZ_SEED").unwrap_or(29_u64).to_le_bytes());
    let config = Config { cases, failure_persistence: None, max_shrink_iters: 500, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &seed));
    let strategy = (any::<Index>(), vec(edit(), 1..6));
    samples.iter().for_each(|sample| stand(&read, sample).expect("a sample"));
    let broken = runner.run(&strategy, |edits| stand(&read, &spoiled(samples, &edits)).map_err(TestCaseError::fail));
    if let Err(TestError::Fail(why, edits)) = broken {
        let file = std::env::temp_dir().join(format!("hairpin-fuzz-{name}"));
        std::fs::write(&file, spoiled(samples, &edits)).expect("room for one input");
        panic!("{name}: {why}; the input is in {}", file.display());
    }
    broken.expect("nothing else goes wrong");
}

/// Reads one input and tells what is wrong with how that went.
pub(crate) fn stand(read: &impl Fn(&[u8]), bytes: &[u8]) -> Result<(), String> {
    let begun = Instant::now();
    let mut outcome = Ok(());
    let taken = allocation_counter::measure(|| outcome = catch_unwind(AssertUnwindSafe(|| read(bytes))));
    let took = begun.elapsed();
    match outcome {
        Err(panic) => {
            let text = panic.downcast_ref::<String>().map(String::as_str);
            Err(format!("it panics: {}", text.or(panic.downcast_ref::<&str>().copied()).unwrap_or_default()))
        }
        Ok(()) if taken.bytes_max > MOST => Err(format!("{} bytes at a time for {}", taken.bytes_max, bytes.len())),
        Ok(()) if took > LONGEST => Err(format!("{took:?} for {} bytes", bytes.len())),
        Ok(()) => Ok(()),
    }
}

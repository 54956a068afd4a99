//! The arguments of the load test.

use std::path::PathBuf;

/// How the program is called.
pub(crate) const USAGE: &str = "\
serve_load ADDRESS:PORT [--viewers N] [--moving N] [--followers N] [--classes N] [--seconds S] [--settle S]
    [--size COLUMNSxROWS] [--pid SERVER] [--colors 256|all] [--sample SCENE]
    [--odd big|late|slow|slow-turning:N] [--at-once true] [--drain true] [--seed N]";

/// A kind of visitors besides those who are counted.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Odd {
    Big,
    Late,
    Slow,
    SlowTurning,
}

pub(crate) struct Arguments {
    pub(crate) address: String,
    pub(crate) viewers: usize,
    pub(crate) moving: usize,
    pub(crate) followers: usize,
    pub(crate) classes: usize,
    pub(crate) seconds: u64,
    pub(crate) settle: u64,
    pub(crate) size: (u32, u32),
    pub(crate) pid: Option<u32>,
    pub(crate) odd: Option<(Odd, usize)>,
    pub(crate) seed: Option<u64>,
    pub(crate) at_once: bool,
    pub(crate) drain: bool,
    pub(crate) has_all_colors: bool,
    pub(crate) sample: Option<PathBuf>,
}

pub(crate) fn arguments() -> Option<Arguments> {
    let mut words = std::env::args().skip(1);
    let mut arguments = Arguments {
        address: words.next()?,
        viewers: 50,
        moving: 50,
        followers: 0,
        classes: 1,
        seconds: 10,
        settle: 2,
        size: (80, 24),
        pid: None,
        odd: None,
        seed: None,
        at_once: false,
        drain: false,
        has_all_colors: true,
        sample: None,
    };
    while let (Some(flag), Some(value)) = (words.next(), words.next()) {
        match flag.as_str() {
            "--viewers" => arguments.viewers = value.parse().ok()?,
            "--moving" => arguments.moving = value.parse().ok()?,
            "--followers" => arguments.followers = value.parse().ok()?,
            "--classes" => arguments.classes = value.parse().ok().filter(|classes| (1..=8).contains(classes))?,
            "--seconds" => arguments.seconds = value.parse().ok()?,
            "--settle" => arguments.settle = value.parse().ok()?,
            "--at-once" => arguments.at_once = value.parse().ok()?,
            "--drain" => arguments.drain = value.parse().ok()?,
            "--colors" => arguments.has_all_colors = ["256", "all"].iter().position(|known| *known == value)? == 1,
            "--sample" => arguments.sample = Some(value.into()),
            "--seed" => arguments.seed = Some(value.parse().ok()?),
            "--odd" => {
                let (kind, count) = value.split_once(':')?;
                let kind = match kind {
                    "big" => Odd::Big,
                    "late" => Odd::Late,
                    "slow" => Odd::Slow,
                    "slow-turning" => Odd::SlowTurning,
                    _ => return None,
                };
                arguments.odd = Some((kind, count.parse().ok()?));
            }
            "--pid" => arguments.pid = Some(value.parse().ok()?),
            "--size" => {
                let (columns, rows) = value.split_once('x')?;
                arguments.size = (columns.parse().ok()?, rows.parse().ok()?);
            }
            _ => return None,
        }
    }
    Some(arguments)
}

impl Arguments {
    /// Returns the number of visitors whose frames are counted.
    pub(crate) fn counted(&self) -> usize {
        self.moving + self.followers
    }

    /// Returns the size of a visitor's window, and whether it has all colours.
    pub(crate) fn terminal(&self, number: usize) -> ((u32, u32), bool) {
        if self.followers > 0 && number >= self.counted() {
            // Its notices have to fit into a row.
            return ((80, 24), true);
        }
        if number < self.moving {
            return (self.size, self.has_all_colors);
        }
        let class = number % self.classes;
        let ((columns, rows), smaller) = (self.size, class as u32 % 4);
        ((columns.saturating_sub(smaller / 2), rows.saturating_sub(smaller % 2)), class < 4 && self.has_all_colors)
    }
}

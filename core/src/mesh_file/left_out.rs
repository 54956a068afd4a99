//! Parts of a mesh that its picture does not show: faulty ones, and unsupported contents.

use super::MeshError;
use super::fault::MeshFault;
use crate::progress::{Reporter, Unfinished};
use crate::text::visible;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The parts of one mesh file that are left out, which become one or two notices.
pub(super) struct LeftOut<'a> {
    reporter: &'a Reporter<'a>,
    /// The name and the bytes of the mesh file.
    name: &'a str,
    bytes: &'a [u8],
    /// The first of the faults that were left out, and the number of them.
    first: Option<MeshFault>,
    faults: usize,
    /// Limit on the faults, one in a hundred parts; `None` while the number of parts is unknown.
    limit: Option<usize>,
    /// Number of triangles that lack a corner because of the faults.
    triangles: usize,
    /// Contents that are not shown: name in the singular, and number.
    not_shown: BTreeMap<Cow<'static, str>, usize>,
}

/// Number of faults that are left out in a file of any size. In larger files, one part in a hundred
/// may be faulty.
const FEW_FAULTS: usize = 5;

impl<'a> LeftOut<'a> {
    pub(super) fn new(reporter: &'a Reporter<'a>, name: &'a str, bytes: &'a [u8]) -> Self {
        Self { reporter, name, bytes, first: None, faults: 0, limit: None, triangles: 0, not_shown: BTreeMap::new() }
    }

    /// Returns what is left out of a piece of the file: nothing so far.
    ///
    /// Any number of its parts may be faulty; [`absorb`](Self::absorb) compares the number with the limit.
    pub(super) fn of_piece(&self) -> Self {
        Self { limit: Some(usize::MAX), ..self.anew() }
    }

    /// Returns what is left out of the file if it is read once more: nothing so far.
    pub(super) fn anew(&self) -> Self {
        Self::new(self.reporter, self.name, self.bytes)
    }

    /// Adds what is left out of the next piece of the file.
    ///
    /// # Errors
    /// The first fault of the file, if too many parts are faulty.
    pub(super) fn absorb(&mut self, piece: Self) -> Result<(), MeshFault> {
        let Self { first, faults, triangles, not_shown, .. } = piece;
        self.triangles += triangles;
        for (what, count) in not_shown {
            self.not_shown(what, count);
        }
        self.faults += faults;
        match first {
            Some(first) => {
                self.first.get_or_insert(first);
                self.check_limit()
            }
            None => Ok(()),
        }
    }

    /// Leaves out a faulty line, face or facet.
    ///
    /// The parts of a file are its lines, unless [`set_fault_limit_for`](Self::set_fault_limit_for) counts others.
    ///
    /// # Errors
    /// The fault, if the reporter takes no notices or the fault is not of a part; the first fault of the file, if too
    /// many parts are faulty.
    #[cold]
    pub(super) fn leave_out(&mut self, fault: MeshFault) -> Result<(), MeshFault> {
        if !self.reporter.takes_notices() || !fault.is_of_part() {
            return Err(fault);
        }
        self.faults += 1;
        self.first.get_or_insert(fault);
        self.check_limit()
    }

    /// Returns the first fault as an error if too many parts are faulty.
    fn check_limit(&mut self) -> Result<(), MeshFault> {
        if self.faults > FEW_FAULTS {
            let lines = || self.bytes.split(|&byte| byte == b'\n').count();
            if self.faults > *self.limit.get_or_insert_with(|| lines() / 100) {
                // This error ends the reading, so that the first fault is needed no longer.
                return self.first.take().map_or(Ok(()), Err);
            }
        }
        Ok(())
    }

    /// Returns a number of faulty lines above which a file is refused, however many lines it has.
    pub(super) fn upper_fault_limit(&self) -> usize {
        if self.takes_notices() { FEW_FAULTS.max((self.bytes.len() + 1) / 100) } else { 0 }
    }

    /// Returns whether faulty parts are left out, not errors.
    pub(super) fn takes_notices(&self) -> bool {
        self.reporter.takes_notices()
    }

    /// Tells of a fault that costs a part of the file other than its shape. `what` says which.
    ///
    /// # Errors
    /// The fault, if the reporter takes no notices, if it is a cancellation, or if a side file is missing and warnings
    /// are errors.
    pub(super) fn notify_of(&mut self, fault: MeshFault, what: &str) -> Result<(), MeshFault> {
        let is_of_side_file = fault.is_of_side_file();
        let error = match self.error_of(fault) {
            Unfinished::Failed(error) => error,
            Unfinished::Cancelled => return Err(Unfinished::Cancelled.into()),
        };
        let notice = || format!("{error} ({what})");
        let is_told = if is_of_side_file {
            self.reporter.warn_instead_of_error(notice)
        } else {
            self.reporter.notify_if_possible(notice)
        };
        if is_told { Ok(()) } else { Err(error.into()) }
    }

    /// Converts a fault of the mesh file to an error with the file's name.
    pub(super) fn error_of(&self, fault: MeshFault) -> Unfinished<MeshError> {
        fault.into_error(self.name, self.bytes)
    }

    /// Converts a fault of a part of the mesh file to one that is never left out.
    pub(super) fn never_left_out(&self, fault: MeshFault) -> MeshFault {
        self.error_of(fault).into()
    }

    /// Sets the limit of faulty parts: one in a hundred of `part_count`.
    pub(super) fn set_fault_limit_for(&mut self, part_count: usize) {
        self.limit = Some(part_count / 100);
    }

    /// Returns whether a fault was left out.
    pub(super) fn has_faults(&self) -> bool {
        self.first.is_some()
    }

    /// Returns the fault of a mesh without triangles: the first one left out, or else `nothing`.
    pub(super) fn fault_of_nothing(&mut self, nothing: String) -> MeshFault {
        self.first.take().unwrap_or_else(|| MeshFault::of_file(nothing))
    }

    /// Counts a triangle that lacks a corner.
    pub(super) fn count_incomplete_triangle(&mut self) {
        self.triangles += 1;
    }

    /// Counts contents that are not shown. `what` is their name in the singular.
    pub(super) fn not_shown(&mut self, what: impl Into<Cow<'static, str>>, count: usize) {
        /// Limit on the kinds of contents, so that notices stay readable.
        const MAX_KINDS: usize = 20;
        if count > 0 && self.not_shown.len() < MAX_KINDS {
            *self.not_shown.entry(what.into()).or_default() += count;
        }
    }

    /// Reports what was left out.
    pub(super) fn report(self) {
        let Self { reporter, name, bytes, first, faults, triangles, not_shown, .. } = self;
        if let Some(Unfinished::Failed(error)) = first.map(|first| first.into_error(name, bytes)) {
            let others = counted([("more fault".into(), faults - 1), ("triangle".into(), triangles)]);
            let with = if others.is_empty() { String::new() } else { format!(", with {others}") };
            reporter.notify_if_possible(|| format!("{error} (ignored{with})"));
        }
        if !not_shown.is_empty() {
            reporter.notify_if_possible(|| visible(&format!("{name}: not shown: {}", counted(not_shown))));
        }
    }
}

/// Returns a list such as "2 skins, 1 line", without the parts whose number is 0.
fn counted(parts: impl IntoIterator<Item = (Cow<'static, str>, usize)>) -> String {
    let counted = parts.into_iter().filter(|&(_, count)| count > 0).map(|(what, count)| match what.split_once(" (") {
        _ if count == 1 => format!("1 {what}"),
        // The `s` of the plural goes before a remark in brackets.
        Some((what, remark)) => format!("{count} {what}s ({remark}"),
        None => format!("{count} {what}s"),
    });
    counted.collect::<Vec<_>>().join(", ")
}

//! Tables: a type with a row for each of its values, and one constant for all that is particular to a row.

/// Writes a table as an enum whose variants are the rows, with the list of them and the constant of each: what else is to
/// be known of a row follows from that constant, so that a new one is a line here and the file with the constant.
macro_rules! table {
    (
        $(#[doc = $about:literal])*
        pub enum $Table:ident: $Kind:ty {
            $($(#[doc = $doc:literal])* $(#[cfg($condition:meta)])? $Row:ident = $kind:expr;)*
        }
    ) => {
        $(#[doc = $about])*
        #[non_exhaustive]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $Table {
            $($(#[doc = $doc])* $(#[cfg($condition)])? $Row,)*
        }

        impl $Table {
            /// All of them, in the order of the table.
            pub const ALL: &[Self] = &[$($(#[cfg($condition)])? Self::$Row,)*];

            /// All that is particular to it.
            const fn row(self) -> &'static $Kind {
                match self {
                    $($(#[cfg($condition)])? Self::$Row => const { &$kind },)*
                }
            }
        }
    };
}

pub(crate) use table;

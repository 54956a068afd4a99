//! Tables: an enum of rows, and one constant with everything particular to a row.

/// Defines an enum whose variants are the rows of a table.
///
/// With the list of them and the constant of each. Everything else about a row follows from its constant, so that a new
/// row is one line here and one file with the constant.
macro_rules! table {
    (
        $(#[$about:meta])*
        pub enum $Table:ident: $Kind:ty {
            $($(#[doc = $doc:literal])* $(#[cfg($condition:meta)])? $Row:ident = $kind:expr;)*
        }
    ) => {
        $(#[$about])*
        #[non_exhaustive]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $Table {
            $($(#[doc = $doc])* $(#[cfg($condition)])? $Row,)*
        }

        impl $Table {
            /// All values, in the order of the table.
            #[doc(hidden)]
            pub const ALL: &[Self] = &[$($(#[cfg($condition)])? Self::$Row,)*];

            /// Returns the constant of the row.
            const fn row(self) -> &'static $Kind {
                match self {
                    $($(#[cfg($condition)])? Self::$Row => const { &$kind },)*
                }
            }
        }
    };
}

pub(crate) use table;

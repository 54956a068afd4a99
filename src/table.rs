//! Tables: enums in which each value has a constant with its properties.

/// Defines an enum whose variants are the rows of a table.
///
/// The macro also defines the list of all variants and a function that returns the constant of each. All code about a
/// row uses its constant, so that a new row takes one line in the table and one file with the constant.
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

            /// Returns the constant with the row's properties.
            const fn row(self) -> &'static $Kind {
                match self {
                    $($(#[cfg($condition)])? Self::$Row => const { &$kind },)*
                }
            }
        }
    };
}

pub(crate) use table;

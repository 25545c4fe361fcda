//! Enums whose variants are listed once, with their names.

/// Defines an enum, and with it `ALL`, its variants in their order. Where every variant says its name (`Draft = "draft"`),
/// there is `name` too, which is also how it is displayed.
#[macro_export]
macro_rules! named {
    ($(#[$about:meta])* $see:vis enum $Enum:ident { $($(#[$of:meta])* $Variant:ident = $name:literal,)+ }) => {
        $crate::named! { $(#[$about])* $see enum $Enum { $($(#[$of])* $Variant,)+ } }

        impl $Enum {
            /// Its name in options, files and reports.
            $see const fn name(self) -> &'static str {
                match self { $(Self::$Variant => $name,)+ }
            }
        }

        impl std::fmt::Display for $Enum {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }
    };
    ($(#[$about:meta])* $see:vis enum $Enum:ident { $($(#[$of:meta])* $Variant:ident,)+ }) => {
        $(#[$about])*
        $see enum $Enum { $($(#[$of])* $Variant,)+ }

        impl $Enum {
            /// All of them, in their order.
            $see const ALL: [Self; [$(stringify!($Variant)),+].len()] = [$(Self::$Variant),+];
        }
    };
}

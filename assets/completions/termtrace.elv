
use builtin;
use str;

set edit:completion:arg-completer[termtrace] = {|@words|
    fn spaces {|n|
        builtin:repeat $n ' ' | str:join ''
    }
    fn cand {|text desc|
        edit:complex-candidate $text &display=$text' '(spaces (- 14 (wcswidth $text)))$desc
    }
    var command = 'termtrace'
    for word $words[1..-1] {
        if (str:has-prefix $word '-') {
            break
        }
        set command = $command';'$word
    }
    var completions = [
        &'termtrace'= {
            cand --eye 'Eye point, instead of the scene''s'
            cand --target 'Target point, instead of the scene''s'
            cand --up 'Up vector, vertical in the picture, instead of the scene''s'
            cand --fov 'Vertical field of view in degrees, instead of the scene''s'
            cand --threads 'Number of threads that trace [default: one per core]'
            cand --color 'Colours to draw with [default: auto]'
            cand --glyphs 'Characters to draw with [default: auto]'
            cand --cell-aspect 'A cell''s height over its width [default: as detected, or 2]'
            cand --map 'The shaded picture, or a map of the scene [default: shaded]'
            cand --samples 'Rays per pixel, also in motion, or `best`: 1, and up to 64 at edges [default: as many as the time allows; best at rest]'
            cand --quality 'Fidelity of the picture while it moves: lower sends fewer bytes [default: exact; in casts, and live on a slow link, equal]'
            cand --max-rate 'Average bandwidth cap in bytes per second, such as 50k or 2M [default: what the link takes]'
            cand --fps 'Frame-rate cap in frames per second [default: 60]'
            cand --move-speed 'Speed at which keys move the eye: a factor from 0.1 to 10 [default: 1]'
            cand --turn-speed 'Speed at which keys turn the view: a factor from 0.1 to 10 [default: 1]'
            cand --reduced-motion 'Each key press moves one step at once; nothing moves by itself [default: false]'
            cand --hint 'Show the keys to press in the lowest row until the first one [default: true]'
            cand --order 'Order in which changed cells are sent [default: color; live, raster until the link is found slow]'
            cand --compressed-link 'The link compresses, as ssh -C does; the same as --order raster'
            cand --quiet 'Do not print the camera on exit'
            cand --no-config 'Ignore config.ron and keys.ron'
            cand -h 'Print help'
            cand --help 'Print help'
            cand -V 'Print version'
            cand --version 'Print version'
            cand scenes 'List the built-in scenes'
            cand frame 'Print one frame, or compare it with a golden frame'
            cand record 'Record a film along a camera path: asciicast, GIF or numbered PNGs'
            cand explain 'Explain one pixel: its ray, what it hit, each light'
            cand check 'Report every fault of a scene file'
            cand describe 'Describe a picture in words'
            cand bench 'Measure how fast a scene is traced'
            cand doctor 'Show what was detected about this terminal, and a test card'
            cand config 'Show the effective settings and where each comes from'
            cand completions 'Print shell completions'
            cand man 'Print the man page'
        }
        &'termtrace;scenes'= {
            cand --no-config 'Ignore config.ron and keys.ron'
            cand -h 'Print help'
            cand --help 'Print help'
        }
        &'termtrace;frame'= {
            cand --eye 'Eye point, instead of the scene''s'
            cand --target 'Target point, instead of the scene''s'
            cand --up 'Up vector, vertical in the picture, instead of the scene''s'
            cand --fov 'Vertical field of view in degrees, instead of the scene''s'
            cand --threads 'Number of threads that trace [default: one per core]'
            cand --size 'The frame''s size in cells [default: 80x24; PNG: 1280x800 pixels, GIF: 480x300]'
            cand --pixels 'The frame''s size in pixels; a cell has two pixels, one above the other, or with --glyphs shape two by four'
            cand --cell-aspect 'A cell''s height over its width'
            cand --samples 'Rays per pixel, the first through its centre; or `best`: 1, and up to 64 at edges [default: 1; PNG and GIF: best]'
            cand --scale 'Picture files: draw each pixel as N by N pixels of the file [default: 1]'
            cand --map 'The shaded picture, or a map of the scene [default: shaded]'
            cand --color 'Colours to draw with [default: auto]'
            cand --glyphs 'Characters to draw with [default: auto]'
            cand --format 'Format to write [default: by the file name''s extension, or text]'
            cand -o 'Write to a file; - is standard output [default: -]'
            cand --output 'Write to a file; - is standard output [default: -]'
            cand --check 'Compare with the frame in a file instead of writing one; exit code 1 and a diff if they differ'
            cand --no-config 'Ignore config.ron and keys.ron'
            cand --bless 'With --check: write the golden frame instead of comparing'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'termtrace;record'= {
            cand --eye 'Eye point, instead of the scene''s'
            cand --target 'Target point, instead of the scene''s'
            cand --up 'Up vector, vertical in the picture, instead of the scene''s'
            cand --fov 'Vertical field of view in degrees, instead of the scene''s'
            cand --threads 'Number of threads that trace [default: one per core]'
            cand --path 'Path of the camera: orbit, or a file of keyframes'
            cand --seconds 'Length of the film in seconds [default: 8, or the length of the path file]'
            cand --fps 'Frames per second [default: 30; GIF: 25]'
            cand --size 'The frame''s size in cells [default: 80x24; PNG: 1280x800 pixels, GIF: 480x300]'
            cand --pixels 'The frame''s size in pixels; a cell has two pixels, one above the other, or with --glyphs shape two by four'
            cand --cell-aspect 'A cell''s height over its width'
            cand --samples 'Rays per pixel, the first through its centre; or `best`: 1, and up to 64 at edges [default: 1; PNG and GIF: best]'
            cand --scale 'Picture files: draw each pixel as N by N pixels of the file [default: 1]'
            cand --map 'The shaded picture, or a map of the scene [default: shaded]'
            cand --order 'Order in which changed cells are sent [default: color; live, raster until the link is found slow]'
            cand --quality 'Fidelity of the picture while it moves: lower sends fewer bytes [default: exact; in casts, and live on a slow link, equal]'
            cand --max-rate 'Average bandwidth cap in bytes per second, such as 50k or 2M [default: what the link takes]'
            cand -o 'Write to FILE.cast (asciicast), FILE.gif, or FILE-%04d.png, numbered from 1; - writes an asciicast to standard output [default: -]'
            cand --output 'Write to FILE.cast (asciicast), FILE.gif, or FILE-%04d.png, numbered from 1; - writes an asciicast to standard output [default: -]'
            cand --no-config 'Ignore config.ron and keys.ron'
            cand --compressed-link 'The link compresses, as ssh -C does; the same as --order raster'
            cand -h 'Print help'
            cand --help 'Print help'
        }
        &'termtrace;explain'= {
            cand --eye 'Eye point, instead of the scene''s'
            cand --target 'Target point, instead of the scene''s'
            cand --up 'Up vector, vertical in the picture, instead of the scene''s'
            cand --fov 'Vertical field of view in degrees, instead of the scene''s'
            cand --threads 'Number of threads that trace [default: one per core]'
            cand --pixel 'The pixel''s column and row, from (0, 0) at the top left'
            cand --size 'The frame''s size in cells [default: 80x24; PNG: 1280x800 pixels, GIF: 480x300]'
            cand --pixels 'The frame''s size in pixels; a cell has two pixels, one above the other, or with --glyphs shape two by four'
            cand --cell-aspect 'A cell''s height over its width'
            cand --no-config 'Ignore config.ron and keys.ron'
            cand -h 'Print help'
            cand --help 'Print help'
        }
        &'termtrace;check'= {
            cand --eye 'Eye point, instead of the scene''s'
            cand --target 'Target point, instead of the scene''s'
            cand --up 'Up vector, vertical in the picture, instead of the scene''s'
            cand --fov 'Vertical field of view in degrees, instead of the scene''s'
            cand --threads 'Number of threads that trace [default: one per core]'
            cand --no-config 'Ignore config.ron and keys.ron'
            cand -h 'Print help'
            cand --help 'Print help'
        }
        &'termtrace;describe'= {
            cand --eye 'Eye point, instead of the scene''s'
            cand --target 'Target point, instead of the scene''s'
            cand --up 'Up vector, vertical in the picture, instead of the scene''s'
            cand --fov 'Vertical field of view in degrees, instead of the scene''s'
            cand --threads 'Number of threads that trace [default: one per core]'
            cand --size 'The size of the screen, in cells'
            cand --no-config 'Ignore config.ron and keys.ron'
            cand -h 'Print help'
            cand --help 'Print help'
        }
        &'termtrace;bench'= {
            cand --scene 'A generated scene instead of a file'
            cand --pixels 'The picture''s size in pixels'
            cand --samples 'Rays per pixel'
            cand --threads 'Number of threads that trace [default: one per core]'
            cand --kernel 'How rays are traced through the scene; affects the time only'
            cand --rounds 'Number of rounds'
            cand --no-config 'Ignore config.ron and keys.ron'
            cand --no-shadow 'Trace no shadow rays'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'termtrace;doctor'= {
            cand --color 'Colours to draw with [default: auto]'
            cand --glyphs 'Characters to draw with [default: auto]'
            cand --cell-aspect 'A cell''s height over its width [default: as detected, or 2]'
            cand --no-config 'Ignore config.ron and keys.ron'
            cand -h 'Print help'
            cand --help 'Print help'
        }
        &'termtrace;config'= {
            cand --color 'Colours to draw with [default: auto]'
            cand --glyphs 'Characters to draw with [default: auto]'
            cand --cell-aspect 'A cell''s height over its width [default: as detected, or 2]'
            cand --map 'The shaded picture, or a map of the scene [default: shaded]'
            cand --samples 'Rays per pixel, also in motion, or `best`: 1, and up to 64 at edges [default: as many as the time allows; best at rest]'
            cand --quality 'Fidelity of the picture while it moves: lower sends fewer bytes [default: exact; in casts, and live on a slow link, equal]'
            cand --max-rate 'Average bandwidth cap in bytes per second, such as 50k or 2M [default: what the link takes]'
            cand --fps 'Frame-rate cap in frames per second [default: 60]'
            cand --move-speed 'Speed at which keys move the eye: a factor from 0.1 to 10 [default: 1]'
            cand --turn-speed 'Speed at which keys turn the view: a factor from 0.1 to 10 [default: 1]'
            cand --reduced-motion 'Each key press moves one step at once; nothing moves by itself [default: false]'
            cand --hint 'Show the keys to press in the lowest row until the first one [default: true]'
            cand --no-config 'Ignore config.ron and keys.ron'
            cand --keys 'Print the keys instead, in the form of keys.ron'
            cand -h 'Print help'
            cand --help 'Print help'
        }
        &'termtrace;completions'= {
            cand --no-config 'Ignore config.ron and keys.ron'
            cand -h 'Print help'
            cand --help 'Print help'
        }
        &'termtrace;man'= {
            cand --no-config 'Ignore config.ron and keys.ron'
            cand -h 'Print help'
            cand --help 'Print help'
        }
    ]
    $completions[$command]
}

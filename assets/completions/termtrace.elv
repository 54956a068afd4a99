
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
            cand --mesh-up 'Axis of a mesh file that points up [default: y; for STL and PLY a guess]'
            cand --threads 'Number of threads that trace [default: one per core]'
            cand --color 'Colours to draw with [default: auto]'
            cand --glyphs 'Characters to draw with [default: auto]'
            cand --cell-aspect 'A cell''s height over its width [default: as detected, or 2]'
            cand --map 'The shaded picture, or a map of the scene [default: shaded]'
            cand --samples 'Rays per pixel, also in motion; best: up to 64 at edges [default: as many as the time allows; best at rest]'
            cand --quality 'Fidelity of the picture while it moves: lower sends fewer bytes [default: exact; in casts, and live on a slow link, equal]'
            cand --max-rate 'Average bandwidth cap in bytes per second, such as 50k or 2M [default: what the link takes]'
            cand --fps 'Frame-rate cap in frames per second [default: 60]'
            cand --move-speed 'Speed at which keys move the eye: a factor from 0.1 to 10 [default: 1]'
            cand --turn-speed 'Speed at which keys turn the view: a factor from 0.1 to 10 [default: 1]'
            cand --reduced-motion 'Each key press moves one step at once; nothing moves by itself [default: false]'
            cand --hint 'Show the keys to press in the lowest row until the first one [default: true]'
            cand --order 'Order in which changed cells are sent [default: color; live, raster until the link is found slow]'
            cand --strict 'Refuse a mesh whose materials or textures are missing, instead of a warning'
            cand --compressed-link 'The link compresses, as ssh -C does; the same as --order raster'
            cand --quiet 'Do not print the camera on exit'
            cand --no-config 'Ignore config.ron and keys.ron'
            cand -h 'Print help; -h prints a summary'
            cand --help 'Print help; -h prints a summary'
            cand -V 'Print the version'
            cand --version 'Print the version'
            cand scenes 'List the built-in scenes'
            cand tour 'Lead through the built-in scenes, with a caption for each'
            cand new 'Write a commented scene to start from, and open it'
            cand frame 'Print one frame, or compare it with a golden frame'
            cand record 'Record a film along a camera path: asciicast, GIF, PNGs'
            cand explain 'Explain one pixel: its ray, what it hit, each light'
            cand check 'Report every fault of a scene file'
            cand describe 'Describe a picture in words'
            cand bench 'Measure how fast a scene is traced'
            cand doctor 'Show what was detected about this terminal, and a test card'
            cand config 'Show the effective settings and where each comes from'
            cand completions 'Print shell completions'
            cand man 'Print the man page'
            cand help 'Print the help of a command'
            cand version 'Print the version'
        }
        &'termtrace;scenes'= {
            cand -h 'Print help; -h prints a summary'
            cand --help 'Print help; -h prints a summary'
            cand --no-config 'no-config'
        }
        &'termtrace;tour'= {
            cand --color 'Colours to draw with [default: auto]'
            cand --glyphs 'Characters to draw with [default: auto]'
            cand --cell-aspect 'A cell''s height over its width [default: as detected, or 2]'
            cand --map 'The shaded picture, or a map of the scene [default: shaded]'
            cand --samples 'Rays per pixel, also in motion; best: up to 64 at edges [default: as many as the time allows; best at rest]'
            cand --quality 'Fidelity of the picture while it moves: lower sends fewer bytes [default: exact; in casts, and live on a slow link, equal]'
            cand --max-rate 'Average bandwidth cap in bytes per second, such as 50k or 2M [default: what the link takes]'
            cand --fps 'Frame-rate cap in frames per second [default: 60]'
            cand --move-speed 'Speed at which keys move the eye: a factor from 0.1 to 10 [default: 1]'
            cand --turn-speed 'Speed at which keys turn the view: a factor from 0.1 to 10 [default: 1]'
            cand --reduced-motion 'Each key press moves one step at once; nothing moves by itself [default: false]'
            cand --hint 'Show the keys to press in the lowest row until the first one [default: true]'
            cand --order 'Order in which changed cells are sent [default: color; live, raster until the link is found slow]'
            cand -h 'Print help; -h prints a summary'
            cand --help 'Print help; -h prints a summary'
            cand --compressed-link 'The link compresses, as ssh -C does; the same as --order raster'
            cand --quiet 'Do not print the camera on exit'
            cand --no-config 'no-config'
        }
        &'termtrace;new'= {
            cand --color 'Colours to draw with [default: auto]'
            cand --glyphs 'Characters to draw with [default: auto]'
            cand --cell-aspect 'A cell''s height over its width [default: as detected, or 2]'
            cand --map 'The shaded picture, or a map of the scene [default: shaded]'
            cand --samples 'Rays per pixel, also in motion; best: up to 64 at edges [default: as many as the time allows; best at rest]'
            cand --quality 'Fidelity of the picture while it moves: lower sends fewer bytes [default: exact; in casts, and live on a slow link, equal]'
            cand --max-rate 'Average bandwidth cap in bytes per second, such as 50k or 2M [default: what the link takes]'
            cand --fps 'Frame-rate cap in frames per second [default: 60]'
            cand --move-speed 'Speed at which keys move the eye: a factor from 0.1 to 10 [default: 1]'
            cand --turn-speed 'Speed at which keys turn the view: a factor from 0.1 to 10 [default: 1]'
            cand --reduced-motion 'Each key press moves one step at once; nothing moves by itself [default: false]'
            cand --hint 'Show the keys to press in the lowest row until the first one [default: true]'
            cand --order 'Order in which changed cells are sent [default: color; live, raster until the link is found slow]'
            cand -h 'Print help; -h prints a summary'
            cand --help 'Print help; -h prints a summary'
            cand --compressed-link 'The link compresses, as ssh -C does; the same as --order raster'
            cand --quiet 'Do not print the camera on exit'
            cand --no-config 'no-config'
        }
        &'termtrace;frame'= {
            cand --eye 'Eye point, instead of the scene''s'
            cand --target 'Target point, instead of the scene''s'
            cand --up 'Up vector, vertical in the picture, instead of the scene''s'
            cand --fov 'Vertical field of view in degrees, instead of the scene''s'
            cand --mesh-up 'Axis of a mesh file that points up [default: y; for STL and PLY a guess]'
            cand --threads 'Number of threads that trace [default: one per core]'
            cand --size 'The frame''s size in cells [default: 80x24]'
            cand --pixels 'Size in pixels [default: PNG 1280x800, GIF 480x300]'
            cand --cell-aspect 'A cell''s height over its width'
            cand --samples 'Rays per pixel; best: 1 to 64 [default: 1; PNG, GIF: best]'
            cand --scale 'Picture files: draw each pixel as N by N pixels of the file [default: 1]'
            cand --map 'The shaded picture, or a map of the scene [default: shaded]'
            cand --color 'Colours to draw with [default: auto]'
            cand --glyphs 'Characters to draw with [default: auto]'
            cand --format 'Format to write [default: by the file name''s extension, or text]'
            cand -o 'Write to a file; - is standard output [default: -]'
            cand --output 'Write to a file; - is standard output [default: -]'
            cand --check 'Compare with the frame in a file, and print a diff'
            cand -h 'Print help; -h prints a summary'
            cand --help 'Print help; -h prints a summary'
            cand --strict 'Refuse a mesh whose materials or textures are missing, instead of a warning'
            cand --bless 'With --check: write the golden frame instead of comparing'
            cand --no-config 'no-config'
        }
        &'termtrace;record'= {
            cand --eye 'Eye point, instead of the scene''s'
            cand --target 'Target point, instead of the scene''s'
            cand --up 'Up vector, vertical in the picture, instead of the scene''s'
            cand --fov 'Vertical field of view in degrees, instead of the scene''s'
            cand --mesh-up 'Axis of a mesh file that points up [default: y; for STL and PLY a guess]'
            cand --threads 'Number of threads that trace [default: one per core]'
            cand --path 'The orbit, or a file of keyframes'
            cand --seconds 'Length in seconds [default: 8, or the path''s]'
            cand --fps 'Frames per second [default: 30; GIF: 25]'
            cand --size 'The frame''s size in cells [default: 80x24]'
            cand --pixels 'Size in pixels [default: PNG 1280x800, GIF 480x300]'
            cand --cell-aspect 'A cell''s height over its width'
            cand --samples 'Rays per pixel; best: 1 to 64 [default: 1; PNG, GIF: best]'
            cand --scale 'Picture files: draw each pixel as N by N pixels of the file [default: 1]'
            cand --map 'The shaded picture, or a map of the scene [default: shaded]'
            cand --order 'Order in which changed cells are sent [default: color; live, raster until the link is found slow]'
            cand --quality 'Fidelity of the picture while it moves: lower sends fewer bytes [default: exact; in casts, and live on a slow link, equal]'
            cand --max-rate 'Average bandwidth cap in bytes per second, such as 50k or 2M [default: what the link takes]'
            cand -o 'FILE.cast (asciicast), FILE.gif, or FILE-%04d.png'
            cand --output 'FILE.cast (asciicast), FILE.gif, or FILE-%04d.png'
            cand -h 'Print help; -h prints a summary'
            cand --help 'Print help; -h prints a summary'
            cand --strict 'Refuse a mesh whose materials or textures are missing, instead of a warning'
            cand --compressed-link 'The link compresses, as ssh -C does; the same as --order raster'
            cand --no-config 'no-config'
        }
        &'termtrace;explain'= {
            cand --eye 'Eye point, instead of the scene''s'
            cand --target 'Target point, instead of the scene''s'
            cand --up 'Up vector, vertical in the picture, instead of the scene''s'
            cand --fov 'Vertical field of view in degrees, instead of the scene''s'
            cand --mesh-up 'Axis of a mesh file that points up [default: y; for STL and PLY a guess]'
            cand --threads 'Number of threads that trace [default: one per core]'
            cand --pixel 'The pixel''s column and row, from (0, 0) at the top left'
            cand --size 'The frame''s size in cells [default: 80x24]'
            cand --pixels 'Size in pixels [default: PNG 1280x800, GIF 480x300]'
            cand --cell-aspect 'A cell''s height over its width'
            cand -h 'Print help; -h prints a summary'
            cand --help 'Print help; -h prints a summary'
            cand --strict 'Refuse a mesh whose materials or textures are missing, instead of a warning'
            cand --no-config 'no-config'
        }
        &'termtrace;check'= {
            cand --eye 'Eye point, instead of the scene''s'
            cand --target 'Target point, instead of the scene''s'
            cand --up 'Up vector, vertical in the picture, instead of the scene''s'
            cand --fov 'Vertical field of view in degrees, instead of the scene''s'
            cand --mesh-up 'Axis of a mesh file that points up [default: y; for STL and PLY a guess]'
            cand --threads 'Number of threads that trace [default: one per core]'
            cand -h 'Print help; -h prints a summary'
            cand --help 'Print help; -h prints a summary'
            cand --strict 'Refuse a mesh whose materials or textures are missing, instead of a warning'
            cand --no-config 'no-config'
        }
        &'termtrace;describe'= {
            cand --eye 'Eye point, instead of the scene''s'
            cand --target 'Target point, instead of the scene''s'
            cand --up 'Up vector, vertical in the picture, instead of the scene''s'
            cand --fov 'Vertical field of view in degrees, instead of the scene''s'
            cand --mesh-up 'Axis of a mesh file that points up [default: y; for STL and PLY a guess]'
            cand --threads 'Number of threads that trace [default: one per core]'
            cand --size 'The size of the screen, in cells'
            cand -h 'Print help; -h prints a summary'
            cand --help 'Print help; -h prints a summary'
            cand --strict 'Refuse a mesh whose materials or textures are missing, instead of a warning'
            cand --no-config 'no-config'
        }
        &'termtrace;bench'= {
            cand --scene 'A generated scene instead of a file'
            cand --pixels 'The picture''s size in pixels'
            cand --samples 'Rays per pixel'
            cand --threads 'Number of threads that trace [default: one per core]'
            cand --kernel 'How rays are traced through the scene; affects the time only'
            cand --rounds 'Number of rounds'
            cand -h 'Print help; -h prints a summary'
            cand --help 'Print help; -h prints a summary'
            cand --no-shadow 'Trace no shadow rays'
            cand --no-config 'no-config'
        }
        &'termtrace;doctor'= {
            cand --color 'Colours to draw with [default: auto]'
            cand --glyphs 'Characters to draw with [default: auto]'
            cand --cell-aspect 'A cell''s height over its width [default: as detected, or 2]'
            cand -h 'Print help; -h prints a summary'
            cand --help 'Print help; -h prints a summary'
            cand --no-config 'Ignore config.ron and keys.ron'
        }
        &'termtrace;config'= {
            cand --color 'Colours to draw with [default: auto]'
            cand --glyphs 'Characters to draw with [default: auto]'
            cand --cell-aspect 'A cell''s height over its width [default: as detected, or 2]'
            cand --map 'The shaded picture, or a map of the scene [default: shaded]'
            cand --samples 'Rays per pixel, also in motion; best: up to 64 at edges [default: as many as the time allows; best at rest]'
            cand --quality 'Fidelity of the picture while it moves: lower sends fewer bytes [default: exact; in casts, and live on a slow link, equal]'
            cand --max-rate 'Average bandwidth cap in bytes per second, such as 50k or 2M [default: what the link takes]'
            cand --fps 'Frame-rate cap in frames per second [default: 60]'
            cand --move-speed 'Speed at which keys move the eye: a factor from 0.1 to 10 [default: 1]'
            cand --turn-speed 'Speed at which keys turn the view: a factor from 0.1 to 10 [default: 1]'
            cand --reduced-motion 'Each key press moves one step at once; nothing moves by itself [default: false]'
            cand --hint 'Show the keys to press in the lowest row until the first one [default: true]'
            cand -h 'Print help; -h prints a summary'
            cand --help 'Print help; -h prints a summary'
            cand --no-config 'Ignore config.ron and keys.ron'
            cand --keys 'Print the keys instead, in the form of keys.ron'
        }
        &'termtrace;completions'= {
            cand -h 'Print help; -h prints a summary'
            cand --help 'Print help; -h prints a summary'
            cand --no-config 'no-config'
        }
        &'termtrace;man'= {
            cand -h 'Print help; -h prints a summary'
            cand --help 'Print help; -h prints a summary'
            cand --no-config 'no-config'
        }
        &'termtrace;help'= {
            cand -h 'Print help; -h prints a summary'
            cand --help 'Print help; -h prints a summary'
            cand --no-config 'no-config'
        }
        &'termtrace;version'= {
            cand -h 'Print help; -h prints a summary'
            cand --help 'Print help; -h prints a summary'
            cand --no-config 'no-config'
        }
    ]
    $completions[$command]
}


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
            cand --eye 'Where to look from, instead of the scene''s eye point'
            cand --target 'Where to look to, instead of the scene''s target'
            cand --up 'What is vertical in the picture, instead of the scene''s up'
            cand --fov 'The vertical field of view in degrees, instead of the scene''s'
            cand --threads 'How many threads trace [default: as many as there are cores]'
            cand --color 'Which colours the picture may have [default: auto]'
            cand --glyphs 'What its cells are made of [default: auto]'
            cand --cell-aspect 'A cell''s height over its width [default: as the terminal says, or 2]'
            cand --map 'The shaded picture, or a map of the scene [default: shaded]'
            cand --samples 'Rays per pixel, also in motion, or `best`: 1, and up to 64 where there are edges [default: as many as the time allows, at rest best]'
            cand --quality 'How near a moving picture is to the right one; it decides bytes, not rays [default: exact; live, on a slow link, equal]'
            cand --max-rate 'The most bytes per second in the mean, such as 50k or 2M; what is most wrong is sent first [default: as many as the link takes]'
            cand --fps 'The most frames per second [default: 60]'
            cand --move-speed 'How fast keys move the eye: a factor from 0.1 to 10 [default: 1]'
            cand --turn-speed 'How fast keys turn the view: a factor from 0.1 to 10 [default: 1]'
            cand --reduced-motion 'Each press of a key moves one step at once; nothing glides or moves by itself [default: false]'
            cand --order 'In which order changed cells are sent [default: color; live, raster until the link is found slow]'
            cand --compressed-link 'The link compresses, as ssh -C does: --order raster'
            cand --quiet 'Do not print the camera on leaving'
            cand --no-config 'Read none of the user''s own files'
            cand -h 'Print help'
            cand --help 'Print help'
            cand -V 'Print version'
            cand --version 'Print version'
            cand frame 'Print one frame, or compare it with a golden one'
            cand record 'Record a film along a camera path: asciicast, GIF or numbered PNGs'
            cand explain 'Say what a pixel comes from: its ray, what that met, the lights'
            cand check 'Say what is wrong with a scene file, or that it is fine'
            cand describe 'Say in words what a picture shows'
            cand bench 'Time the tracing of a scene'
            cand doctor 'Say what this terminal can do and who says so, and draw a test card'
            cand config 'Say which settings hold, and who says so'
            cand completions 'Print what a shell is to know to complete arguments'
            cand man 'Print the manual, for man'
        }
        &'termtrace;frame'= {
            cand --eye 'Where to look from, instead of the scene''s eye point'
            cand --target 'Where to look to, instead of the scene''s target'
            cand --up 'What is vertical in the picture, instead of the scene''s up'
            cand --fov 'The vertical field of view in degrees, instead of the scene''s'
            cand --threads 'How many threads trace [default: as many as there are cores]'
            cand --size 'The frame''s size in cells [default: 80x24]'
            cand --pixels 'The frame''s size in pixels; a cell has two of them, one above the other, or with --glyphs shape two by four'
            cand --cell-aspect 'A cell''s height over its width'
            cand --samples 'Rays per pixel, the first through its centre; or `best`: 1, and up to 64 where there are edges'
            cand --scale 'Picture files: make each pixel N by N of the file''s [default: 1]'
            cand --map 'The shaded picture, or a map of the scene [default: shaded]'
            cand --color 'Which colours the picture may have [default: auto]'
            cand --glyphs 'What its cells are made of [default: auto]'
            cand --format 'What to write [default: as the file name''s ending says, or text]'
            cand -o 'Write to a file; - is standard output [default: -]'
            cand --output 'Write to a file; - is standard output [default: -]'
            cand --check 'Compare with the frame in a file instead of writing one; exit code 1 and a diff if they differ'
            cand --no-config 'Read none of the user''s own files'
            cand --bless 'With --check: write the file'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'termtrace;record'= {
            cand --eye 'Where to look from, instead of the scene''s eye point'
            cand --target 'Where to look to, instead of the scene''s target'
            cand --up 'What is vertical in the picture, instead of the scene''s up'
            cand --fov 'The vertical field of view in degrees, instead of the scene''s'
            cand --threads 'How many threads trace [default: as many as there are cores]'
            cand --path 'How the camera moves: orbit, or a file of keyframes'
            cand --seconds 'How long the film is [default: 8, or as long as the path file]'
            cand --fps 'Frames per second'
            cand --size 'The frame''s size in cells [default: 80x24]'
            cand --pixels 'The frame''s size in pixels; a cell has two of them, one above the other, or with --glyphs shape two by four'
            cand --cell-aspect 'A cell''s height over its width'
            cand --samples 'Rays per pixel, the first through its centre; or `best`: 1, and up to 64 where there are edges'
            cand --scale 'Picture files: make each pixel N by N of the file''s [default: 1]'
            cand --map 'The shaded picture, or a map of the scene [default: shaded]'
            cand --order 'In which order changed cells are sent [default: color; live, raster until the link is found slow]'
            cand --quality 'How near a moving picture is to the right one; it decides bytes, not rays [default: exact; live, on a slow link, equal]'
            cand --max-rate 'The most bytes per second in the mean, such as 50k or 2M; what is most wrong is sent first [default: as many as the link takes]'
            cand -o 'Write to FILE.cast (asciicast), FILE.gif, or numbered from 1 to FILE-%04d.png; - is an asciicast to standard output [default: -]'
            cand --output 'Write to FILE.cast (asciicast), FILE.gif, or numbered from 1 to FILE-%04d.png; - is an asciicast to standard output [default: -]'
            cand --no-config 'Read none of the user''s own files'
            cand --compressed-link 'The link compresses, as ssh -C does: --order raster'
            cand -h 'Print help'
            cand --help 'Print help'
        }
        &'termtrace;explain'= {
            cand --eye 'Where to look from, instead of the scene''s eye point'
            cand --target 'Where to look to, instead of the scene''s target'
            cand --up 'What is vertical in the picture, instead of the scene''s up'
            cand --fov 'The vertical field of view in degrees, instead of the scene''s'
            cand --threads 'How many threads trace [default: as many as there are cores]'
            cand --pixel 'The pixel''s column and row, from (0, 0) at the top left'
            cand --size 'The frame''s size in cells [default: 80x24]'
            cand --pixels 'The frame''s size in pixels; a cell has two of them, one above the other, or with --glyphs shape two by four'
            cand --cell-aspect 'A cell''s height over its width'
            cand --no-config 'Read none of the user''s own files'
            cand -h 'Print help'
            cand --help 'Print help'
        }
        &'termtrace;check'= {
            cand --eye 'Where to look from, instead of the scene''s eye point'
            cand --target 'Where to look to, instead of the scene''s target'
            cand --up 'What is vertical in the picture, instead of the scene''s up'
            cand --fov 'The vertical field of view in degrees, instead of the scene''s'
            cand --threads 'How many threads trace [default: as many as there are cores]'
            cand --no-config 'Read none of the user''s own files'
            cand -h 'Print help'
            cand --help 'Print help'
        }
        &'termtrace;describe'= {
            cand --eye 'Where to look from, instead of the scene''s eye point'
            cand --target 'Where to look to, instead of the scene''s target'
            cand --up 'What is vertical in the picture, instead of the scene''s up'
            cand --fov 'The vertical field of view in degrees, instead of the scene''s'
            cand --threads 'How many threads trace [default: as many as there are cores]'
            cand --size 'The size of the screen whose picture is told, in cells'
            cand --no-config 'Read none of the user''s own files'
            cand -h 'Print help'
            cand --help 'Print help'
        }
        &'termtrace;bench'= {
            cand --scene 'A scene that is made rather than read'
            cand --pixels 'The picture''s size in pixels'
            cand --samples 'Rays per pixel'
            cand --threads 'How many threads trace [default: as many as there are cores]'
            cand --kernel 'How the rays go through the scene: it changes how long that takes, and nothing else'
            cand --rounds 'How many times'
            cand --no-config 'Read none of the user''s own files'
            cand --no-shadow 'Trace no rays to the lights'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'termtrace;doctor'= {
            cand --color 'Which colours the picture may have [default: auto]'
            cand --glyphs 'What its cells are made of [default: auto]'
            cand --cell-aspect 'A cell''s height over its width [default: as the terminal says, or 2]'
            cand --no-config 'Read none of the user''s own files'
            cand -h 'Print help'
            cand --help 'Print help'
        }
        &'termtrace;config'= {
            cand --color 'Which colours the picture may have [default: auto]'
            cand --glyphs 'What its cells are made of [default: auto]'
            cand --cell-aspect 'A cell''s height over its width [default: as the terminal says, or 2]'
            cand --map 'The shaded picture, or a map of the scene [default: shaded]'
            cand --samples 'Rays per pixel, also in motion, or `best`: 1, and up to 64 where there are edges [default: as many as the time allows, at rest best]'
            cand --quality 'How near a moving picture is to the right one; it decides bytes, not rays [default: exact; live, on a slow link, equal]'
            cand --max-rate 'The most bytes per second in the mean, such as 50k or 2M; what is most wrong is sent first [default: as many as the link takes]'
            cand --fps 'The most frames per second [default: 60]'
            cand --move-speed 'How fast keys move the eye: a factor from 0.1 to 10 [default: 1]'
            cand --turn-speed 'How fast keys turn the view: a factor from 0.1 to 10 [default: 1]'
            cand --reduced-motion 'Each press of a key moves one step at once; nothing glides or moves by itself [default: false]'
            cand --no-config 'Read none of the user''s own files'
            cand --keys 'Print what keys do instead, in the form of keys.ron'
            cand -h 'Print help'
            cand --help 'Print help'
        }
        &'termtrace;completions'= {
            cand --no-config 'Read none of the user''s own files'
            cand -h 'Print help'
            cand --help 'Print help'
        }
        &'termtrace;man'= {
            cand --no-config 'Read none of the user''s own files'
            cand -h 'Print help'
            cand --help 'Print help'
        }
    ]
    $completions[$command]
}

# What a shopper reads, in German.

language = Deutsch

# No person is in view
attract-heading = Sehen Sie, wie es sitzt, bevor Sie es anprobieren
attract-measure = Treten Sie auf die Markierung. Der Spiegel nimmt in einer Sekunde Maß.
attract-fit = Sehen Sie sich in Ihrer Größe, und wo es eng wird.
attract-compare = Stellen Sie zwei Größen nebeneinander.
attract-private = Nichts wird gespeichert, nichts wird gesendet. Wenn Sie gehen, werden Sie vergessen.

# A person has stepped in
guide-heading = Stellen Sie sich auf die Markierung
guide-heading-seated = Schauen Sie zum Spiegel
guide-pose = Füße auseinander, die Arme etwas vom Körper weg.
guide-pose-seated = Sitzen Sie aufrecht, die Arme etwas vom Körper weg.
guide-nearer = Kommen Sie etwas näher.
guide-farther = Gehen Sie einen Schritt zurück.
guide-left = Gehen Sie etwas nach links.
guide-right = Gehen Sie etwas nach rechts.
guide-alone = Bitte nur eine Person auf einmal.
guide-unseen = Der Spiegel sieht Sie noch nicht. Treten Sie auf die Markierung.
camera-lost = Die Kamera antwortet gerade nicht. Bitte warten Sie einen Augenblick.
camera-covered = Etwas verdeckt die Kamera. Bitte machen Sie sie frei.
guide-soon = Gleich geht es los.

# Measuring
measuring-heading = Einen Moment, bitte
measuring-body = Es wird Maß genommen
measuring-dress = Die Kleidung wird angezogen
turn-offer = Wenn Sie mögen, drehen Sie sich einmal langsam um sich selbst. Ihre Maße werden genauer.
turn-on = Drehen Sie sich langsam weiter.
turn-enough = Danke, das war rundherum.

# What could not be measured
unmeasured-heading = Das hat nicht geklappt
unmeasured-why = Der Spiegel muss Sie eine Sekunde lang allein und vom Kopf bis zu den Knien sehen. Weite Mäntel und Taschen verdecken den Körper.
unmeasured-seated = Sitzen Sie? Dann wählen Sie „Ich sitze“.
partly-heading = Gemessen, so weit es geht
partly-missing = Nicht zu sehen: { $parts }.
partly-guess = Dort steht ein durchschnittlicher Körper Ihrer Größe. Diese Stellen sind weniger sicher.
partly-cure = Ein Maßband an Taille und Hüfte macht es sicher.

# The fitted body
fitting-size = { $garment }, Größe { $size }
fitting-best = Größe { $size } passt Ihnen am besten.
fitting-nearest = Größe { $size } kommt am nächsten, passt aber nicht überall.
fitting-one-size = Es gibt eine Größe.
fitting-size-unknown = So gezeigt, wie es gemacht ist: Die Größe ist nicht bekannt.
fitting-sure = Zu { $percent } % sicher.
fitting-unsure = Es ist knapp: { $percent } %.
fitting-better = Größe { $size } würde Ihnen besser passen.
fitting-tape = Ein Maßband hilft: { $zone }.
fitting-smaller = Auch die kleinste Größe ist für größere Maße gedacht. Sie sehen die nächstliegende.
fitting-larger = Auch die größte Größe ist für kleinere Maße gedacht. Sie sehen die nächstliegende.
fitting-dressing = Wird angezogen
fitting-refused = Das ließ sich nicht anziehen. Sie sehen, was Sie vorher trugen.
own-picture-kept = Das sehen nur Sie. Ihr Bild wird weder gespeichert noch gesendet.
own-picture-soon = Ihr Bild kommt gleich.
own-picture-cannot = Auf das Bild dieser Kamera lässt sich die Kleidung nicht legen. Wählen Sie die Figur.
own-picture-nobody = Der Spiegel sieht Sie nicht. Treten Sie auf die Markierung.
own-picture-back = Treten Sie etwas zurück, damit die Kleidung ins Bild passt.
own-picture-still = Bleiben Sie einen Moment stehen, dem Spiegel zugewandt.

# The shopper’s own face on the mannequin
face-heading = Ihr Gesicht an der Figur
face-what = Wenn Sie drücken, wird ein Bild von Ihnen aufgenommen, und die Figur bekommt Ihr Gesicht. Stehen Sie aufrecht und sehen Sie in den Spiegel.
face-kept = Bild und Gesicht sind nur im Speicher dieses Spiegels. Sie werden nirgendwohin gesendet und gelöscht, sobald Sie das Gesicht entfernen oder gehen.
face-taking = Ihr Gesicht wird übertragen
face-on = Die Figur hat Ihr Gesicht.
face-no-picture = Die Kamera hat kein Bild geliefert. Bitte versuchen Sie es gleich noch einmal.
face-unseen = Es war kein Gesicht zu sehen. Stellen Sie sich vor den Spiegel, sehen Sie hinein und versuchen Sie es noch einmal.
face-far = Ihr Gesicht ist zu weit weg. Kommen Sie näher und versuchen Sie es noch einmal.
face-turned = Ihr Gesicht war abgewandt. Sehen Sie gerade in den Spiegel und versuchen Sie es noch einmal.
face-unlike = Ihr Gesicht ließ sich nicht übertragen. Halten Sie Haare und Hände davon weg und versuchen Sie es noch einmal.

# The garments
garments-heading = Was möchten Sie anprobieren?
garments-worn = Das tragen Sie gerade
garments-take-off = Noch einmal tippen, um es auszuziehen
garments-instead = Statt: { $others }
garment-strap-dress = Sommerkleid
garment-tee = T-Shirt
garment-wide-leg-trousers = Weite Hose
garment-mens-blazer = Offene Jacke
garment-circle-skirt = Tellerrock
garment-slim-trousers = Schmale Hose
garment-shirt = Karohemd
garment-jumper = Streifenpullover
garment-mens-shirt = Herrenhemd
garment-mens-trousers = Herrenhose
garment-blazer = Blazer
garment-coat = Mantel
colour-of = Farbe: { $colour }
colour-own = Wie gewebt
colour-coral = Koralle
colour-ivory = Elfenbein
colour-sky = Himmelblau
colour-moss = Moosgrün
colour-navy = Marineblau
colour-denim = Jeansblau
colour-white = Weiß
colour-ochre = Ocker
colour-brick = Ziegelrot
colour-charcoal = Anthrazit
colour-sand = Sandfarben

# Fit by zone
zones-heading = So sitzt Größe { $size }
zones-held =
    Es hält { $level ->
        [neck] am Hals
        [shoulders] an den Schultern
        [bust] an der Brust
        [underbust] unter der Brust
        [waist] an der Taille
        [crotch] im Schritt
       *[feet] an den Füßen
    }.
zone-chest = Brust
zone-waist = Taille
zone-hip = Hüfte
fit-ease = { $zone }: { $feel } (+{ $ease } ± { $sigma } cm)
fit-lack = { $zone }: { $feel } (-{ $ease } ± { $sigma } cm)
fit-perhaps = { $fit }, vielleicht { $feel }
fit-unknown = { $zone }: nicht zu sehen, daher ist der Sitz unbekannt
feel-unknown = unbekannt
feel-too-tight = viel zu eng
feel-tight = eng
feel-snug = körpernah
feel-right = genau richtig
feel-roomy = bequem
feel-loose = weit
feel-too-loose = viel zu weit
legend-loose = weit
legend-tight = eng

# Why
zone-heading = { $zone }: warum?
zone-body = Ihre { $zone } misst etwa { $body } cm, plus oder minus { $sigma } cm.
zone-garment = Das Kleidungsstück misst dort { $garment } cm.
zone-comfort = Bei diesem Schnitt fühlen sich { $least } bis { $most } cm Spielraum richtig an.
zone-stretch = Bei diesem Schnitt fühlt sich alles von { $least } cm Dehnung bis { $most } cm Spielraum richtig an.
zone-primary = Nach diesem Maß wird die Größe gewählt.
zone-taped = Sie haben es mit dem Maßband gemessen.
zone-seen = Es wurde an der Oberfläche Ihres Körpers gemessen.
zone-bones = Nur Körpergröße und Schultern waren zu sehen. Der Umfang folgt daraus und ist unsicher.
zone-guessed = Es war nicht zu sehen. Dort steht ein Durchschnitt für Ihre Körpergröße.
zone-surer-tape = Ein Maßband macht es sicher.
zone-surer-again = Ohne Mantel und Tasche noch einmal messen macht es sicherer.

# Two sizes
compare-heading = Größe { $left } oder { $right }?
compare-zone = { $zone }: { $left } ist { $left-feel }, { $right } ist { $right-feel }
compare-same = { $zone }: beide sind { $feel }
compare-unknown = { $zone }: für beide Größen unbekannt
compare-draping = Beide Größen werden angezogen
compare-refused = Beide Größen ließen sich nicht anziehen. Die Worte gelten trotzdem.

# Measures by tape
own-heading = Ihre eigenen Maße
own-why = Was Sie mit dem Maßband gemessen haben, zählt mehr als das, was der Spiegel sieht. Wählen Sie ein Maß.
own-forgotten = Wenn Sie gehen, werden auch sie vergessen.
own-given = Übernommen: { $length }.
own-chest = Brust
own-waist = Taille
own-hip = Hüfte
own-stature = Körpergröße
own-underbust = Unterbrust
own-leg = Beininnenlänge
own-arm = Armlänge
own-shoulders = Schulterbreite
own-neck = Hals
own-thigh = Oberschenkel
own-torso = Hals bis Schritt
length-cm = { $length } cm
length-inch = { $length } Zoll
entry-heading = { $measure }: wie viel?
entry-how = Geben Sie die Länge ein und übernehmen Sie sie.
entry-empty = Geben Sie zuerst eine Länge ein.
entry-impossible = { $measure }: Menschen haben { $low } bis { $high }. Bitte prüfen Sie Zahl und Einheit.
entry-contradiction = { $measure }: { $given } passt nicht zu Ihren anderen Maßen. Nach diesen wären es { $expected } ± { $sigma }. Messen Sie noch einmal, oder entfernen Sie eines.

# The picture
picture-heading = Ihr Bild
picture-taking = Das Bild wird gemacht
picture-scan = Scannen Sie den Code mit Ihrem Telefon. Er enthält das Bild selbst; nichts wird gesendet.
picture-served = Scannen Sie den Code, während Ihr Telefon im Netz dieses Ladens ist. Dort wird das Bild unverschlüsselt bereitgestellt; es verlässt den Laden nicht.
picture-served-in = Scannen Sie den Code, während Ihr Telefon im Netz { $network } ist. Dort wird das Bild unverschlüsselt bereitgestellt; es verlässt den Laden nicht.
picture-until =
    { $minutes ->
        [0] Es wird in weniger als einer Minute gelöscht.
        [one] Es wird in { $minutes } Minute gelöscht.
       *[other] Es wird in { $minutes } Minuten gelöscht.
    }
picture-failed = Das Bild hat nicht geklappt. Bitte versuchen Sie es noch einmal.

# Settings
settings-heading = Sprache und Einstellungen
settings-stored = Der Spiegel speichert nichts. Er kennt Ihre Maße nur, solange Sie hier stehen, und vergisst sie, wenn Sie gehen.
settings-known =
    { $count ->
        [0] Er kennt kein Maß von Ihnen.
        [one] Er kennt gerade { $count } Maß von Ihnen.
       *[other] Er kennt gerade { $count } Maße von Ihnen.
    }

# Another person
second-heading = Sind das noch Sie?
second-why = Hier scheint jemand anders zu stehen. Was zu sehen war, ist verdeckt.
second-seconds =
    { $seconds ->
        [one] In { $seconds } Sekunde wird alles vergessen.
       *[other] In { $seconds } Sekunden wird alles vergessen.
    }

# No person is in view
leaving-heading = Sind Sie noch da?
leaving-seconds =
    { $seconds ->
        [one] In { $seconds } Sekunde werden Sie vergessen.
       *[other] In { $seconds } Sekunden werden Sie vergessen.
    }

# What can be pressed
do-begin = Los geht’s
do-measure = Maß nehmen
do-measure-again = Noch einmal messen
do-seated = Ich sitze
do-garments = Kleidung wählen
do-garments-more = Mehr Kleider
do-garments-before = Kleider davor
do-zones = Wie sitzt es?
do-compare = Zwei Größen vergleichen
do-smaller = Kleinere Größe
do-larger = Größere Größe
do-size = Größe { $size }
do-turn-left = Nach links drehen
do-turn-right = Nach rechts drehen
do-fit-map = Passform in Farben
do-own-picture = Mich selbst sehen
do-mannequin = Die Figur sehen
do-face = Mein Gesicht
do-face-put-on = Mein Gesicht übertragen
do-face-again = Noch einmal versuchen
do-face-away = Gesicht entfernen
do-picture = Bild machen
do-show-picture = Bild zeigen
do-delete-picture = Jetzt löschen
do-picture-link = Großes Bild
do-picture-own = Nicht in diesem Netz
do-settings = Sprache und Einstellungen
do-large = Große Schrift
do-wear = Größe { $size } tragen
do-own-measures = Ich kenne meine Maße
do-delete = Löschen
do-inches = In Zoll
do-centimetres = In Zentimetern
do-accept = Übernehmen
do-remove = Dieses Maß entfernen
do-go-on = Weiter
do-back = Zurück
do-stay = Ich bin noch da
do-still-me = Ich bin es noch
do-begin-anew = Neu beginnen
do-leave = Fertig: mich vergessen

# Parts of the body that are measured
part-stature = Körpergröße
part-shoulders = Schultern
part-chest = Brust
part-waist = Taille
part-hip = Hüfte
part-legs = Beinlänge
list-and = { $first } und { $last }
list-comma = { $first }, { $last }

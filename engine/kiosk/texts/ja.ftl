# What a shopper reads, in Japanese.

language = 日本語

# No person is in view
attract-heading = 試着の前に、着た感じをご覧ください
attract-measure = マークの上にお立ちください。鏡が1秒で採寸します。
attract-fit = ご自分のサイズで着た姿と、きついところが分かります。
attract-compare = 2つのサイズを並べて比べられます。
attract-private = 何も保存せず、何も送信しません。離れると、すべて消えます。

# A person has stepped in
guide-heading = マークの上にお立ちください
guide-heading-seated = 鏡のほうを向いてください
guide-pose = 足を開き、腕を体から少し離してください。
guide-pose-seated = 背筋を伸ばして座り、腕を体から少し離してください。
guide-nearer = もう少し前へどうぞ。
guide-farther = 少し後ろへお下がりください。
guide-left = 少し左へお動きください。
guide-right = 少し右へお動きください。
guide-alone = お一人ずつお願いします。
guide-unseen = まだお姿が見えません。マークの上にお立ちください。
camera-lost = カメラが今うごいていません。少々お待ちください。
camera-covered = カメラのまえに何かあります。取り除いてください。
guide-soon = まもなく採寸を始めます。

# Measuring
measuring-heading = 少々お待ちください
measuring-body = 採寸しています
measuring-dress = 服を着せています
turn-offer = よろしければ、ゆっくり一回りしてください。寸法がより確かになります。
turn-on = そのままゆっくり回ってください。
turn-enough = ありがとうございます。一回り見えました。

# What could not be measured
unmeasured-heading = うまく測れませんでした
unmeasured-why = お一人で、頭からひざまでが1秒間見える必要があります。ゆったりしたコートやバッグは体を隠してしまいます。
unmeasured-seated = 座っている場合は「座っています」をお選びください。
partly-heading = 測れるところまで測りました
partly-missing = 見えなかったところ：{ $parts }
partly-guess = そこは同じ身長の平均的な体で補っているため、確かさが下がります。
partly-cure = ウエストとヒップをメジャーで測ると確かになります。

# The fitted body
fitting-size = { $garment }　サイズ{ $size }
fitting-best = いちばん合うのはサイズ{ $size }です。
fitting-nearest = { $size } サイズが最も近いですが、合わない部分があります。
fitting-one-size = サイズは一つです。
fitting-size-unknown = 作られたままを表示しています。サイズは不明です。
fitting-sure = 確かさは{ $percent }%です。
fitting-unsure = 迷うところです（{ $percent }%）。
fitting-better = サイズ{ $size }のほうが合いそうです。
fitting-tape = { $zone }をメジャーで測ると確かです。
fitting-smaller = いちばん小さいサイズでも大きめです。最も近いサイズを表示しています。
fitting-larger = いちばん大きいサイズでも小さめです。最も近いサイズを表示しています。
fitting-dressing = 着せています
fitting-refused = この服は着せられませんでした。前の服を表示しています。
own-picture-kept = この映像はあなただけのものです。保存も送信もしません。
own-picture-soon = まもなく映像が表示されます。
own-picture-cannot = このカメラの映像には服を重ねられません。マネキンを選んでください。
own-picture-nobody = 鏡にあなたが映っていません。印の上に立ってください。
own-picture-back = 服が映像に収まるように、少し下がってください。
own-picture-still = 鏡に向かって、少しの間動かないでください。

# The shopper’s own face on the mannequin
face-heading = マネキンにあなたの顔
face-what = 押すとあなたの写真を一枚撮り、マネキンの顔があなたの顔になります。まっすぐ立って鏡を見てください。
face-kept = 写真と顔はこの鏡のメモリーの中だけにあります。どこにも送信せず、顔を外すかその場を離れると消去します。
face-taking = あなたの顔を付けています
face-on = マネキンの顔があなたの顔になりました。
face-no-picture = カメラから写真が得られませんでした。少し待ってもう一度お試しください。
face-unseen = 顔が見つかりませんでした。鏡の前に立ち、鏡を見てもう一度お試しください。
face-far = 顔が遠すぎます。近づいてもう一度お試しください。
face-turned = 顔が横を向いていました。鏡をまっすぐ見てもう一度お試しください。
face-unlike = 顔を付けられませんでした。髪や手を顔からよけて、もう一度お試しください。

# The garments
garments-heading = どれを試しますか？
garments-worn = 着用中です
garments-take-off = もう一度触れると脱ぎます
garments-instead = 入れ替え：{ $others }
garment-strap-dress = サンドレス
garment-tee = Tシャツ
garment-wide-leg-trousers = ワイドパンツ
garment-mens-blazer = オープンジャケット
garment-circle-skirt = サーキュラースカート
garment-slim-trousers = スリムパンツ
garment-shirt = ギンガムシャツ
garment-jumper = ボーダーセーター
garment-mens-shirt = メンズシャツ
garment-mens-trousers = メンズパンツ
garment-blazer = ブレザー
garment-coat = コート
colour-of = 色：{ $colour }
colour-own = 生地の色
colour-coral = コーラル
colour-ivory = アイボリー
colour-sky = スカイブルー
colour-moss = モスグリーン
colour-navy = ネイビー
colour-denim = デニムブルー
colour-white = ホワイト
colour-ochre = マスタード
colour-brick = れんが色
colour-charcoal = チャコール
colour-sand = サンドベージュ

# Fit by zone
zones-heading = サイズ{ $size }の着心地
zones-held =
    この服は{ $level ->
        [neck] 首
        [shoulders] 肩
        [bust] 胸
        [underbust] 胸の下
        [waist] ウエスト
        [crotch] 股
       *[feet] 足
    }で支えます。
zone-chest = バスト
zone-waist = ウエスト
zone-hip = ヒップ
fit-ease = { $zone }：{ $feel }（+{ $ease } ± { $sigma } cm）
fit-lack = { $zone }：{ $feel }（-{ $ease } ± { $sigma } cm）
fit-perhaps = { $fit }、{ $feel }かもしれません
fit-unknown = { $zone }：見えなかったため、着心地は分かりません
feel-unknown = 分かりません
feel-too-tight = かなりきつい
feel-tight = きつい
feel-snug = ぴったり
feel-right = ちょうどよい
feel-roomy = ゆったり
feel-loose = ゆるい
feel-too-loose = かなりゆるい
legend-loose = ゆるい
legend-tight = きつい

# Why
zone-heading = { $zone }：その理由
zone-body = お客様の{ $zone }は約{ $body } cm（± { $sigma } cm）です。
zone-garment = 服のその部分は{ $garment } cmです。
zone-comfort = この型では、ゆとり{ $least }～{ $most } cmが快適です。
zone-stretch = この型では、{ $least } cm伸びた状態からゆとり{ $most } cmまでが快適です。
zone-primary = サイズはこの寸法で決まります。
zone-taped = お客様がメジャーで測った寸法です。
zone-seen = 体の表面から測りました。
zone-bones = 見えたのは身長と肩だけです。この寸法はそこから求めたもので、確かではありません。
zone-guessed = 見えなかったため、同じ身長の平均を使っています。
zone-surer-tape = メジャーで測ると確かになります。
zone-surer-again = コートやバッグなしで測り直すと、より確かになります。

# Two sizes
compare-heading = サイズ{ $left }と{ $right }、どちらにしますか？
compare-zone = { $zone }：{ $left }は{ $left-feel }、{ $right }は{ $right-feel }
compare-same = { $zone }：どちらも{ $feel }
compare-unknown = { $zone }：どちらも分かりません
compare-draping = 2つのサイズを着せています
compare-refused = 2つのサイズを着せられませんでした。説明はそのままご参考になります。

# Measures by tape
own-heading = ご自分の寸法
own-why = メジャーで測った寸法は、鏡で見た寸法より確かです。お選びください。
own-forgotten = 離れると、これもすべて消えます。
own-given = 今の寸法：{ $length }
own-chest = バスト
own-waist = ウエスト
own-hip = ヒップ
own-stature = 身長
own-underbust = アンダーバスト
own-leg = 股下
own-arm = 腕の長さ
own-shoulders = 肩幅
own-neck = 首
own-thigh = もも
own-torso = 首から股まで
length-cm = { $length } cm
length-inch = { $length }インチ
entry-heading = { $measure }はいくつですか？
entry-how = 長さを入れて、決定に触れてください。
entry-empty = まず長さを入れてください。
entry-impossible = { $measure }は{ $low }～{ $high }の間です。長さとセンチ・インチをお確かめください。
entry-contradiction = { $measure }：{ $given }は、ほかの寸法と合いません。ほかの寸法からは{ $expected } ± { $sigma }です。もう一度測るか、どれかを削除してください。

# The picture
picture-heading = お客様の画像
picture-taking = 画像を作っています
picture-scan = スマートフォンでコードを読み取ってください。画像はコードの中にあり、何も送信しません。
picture-served = スマートフォンがここのネットワークにあるとき、コードを読み取ってください。画像はここだけで送信し、ほかには送信しません。
picture-served-in = スマートフォンがネットワーク { $network } にあるとき、コードを読み取ってください。画像はここだけで送信し、ほかには送信しません。
picture-until =
    { $minutes ->
        [0] 1分以内に削除されます。
       *[other] 約{ $minutes }分後に削除されます。
    }
picture-failed = 画像を作れませんでした。もう一度お試しください。

# Settings
settings-heading = 言語と設定
settings-stored = 鏡は何も保存しません。寸法はここにいらっしゃる間だけ使い、離れると消えます。
settings-known =
    { $count ->
        [0] 今、お客様の寸法はありません。
       *[other] 今、お客様の寸法が{ $count }つあります。
    }

# Another person
second-heading = 同じお客様ですか？
second-why = 別の方がいらっしゃるようです。表示していた内容は隠しました。
second-seconds =
    { $seconds ->
       *[other] { $seconds }秒後にすべて消えます。
    }

# No person is in view
leaving-heading = まだいらっしゃいますか？
leaving-seconds =
    { $seconds ->
       *[other] { $seconds }秒後にすべて消えます。
    }

# What can be pressed
do-begin = はじめる
do-measure = 採寸する
do-measure-again = もう一度測る
do-seated = 座っています
do-garments = 服を選ぶ
do-garments-more = ほかの服
do-garments-before = 前の服
do-zones = 着心地を見る
do-compare = サイズを比べる
do-smaller = 小さいサイズ
do-larger = 大きいサイズ
do-size = サイズ{ $size }
do-turn-left = 左へ回す
do-turn-right = 右へ回す
do-fit-map = フィットマップ
do-own-picture = 自分を見る
do-mannequin = マネキンを見る
do-face = 自分の顔
do-face-put-on = 自分の顔を付ける
do-face-again = もう一度試す
do-face-away = 顔を外す
do-picture = 画像を作る
do-show-picture = 画像を見る
do-delete-picture = 今すぐ削除
do-picture-link = 大きい画像
do-picture-own = 小さい画像
do-settings = 言語と設定
do-large = 大きな文字
do-wear = サイズ{ $size }を着る
do-own-measures = 寸法が分かっています
do-delete = 消す
do-inches = インチで
do-centimetres = センチで
do-accept = 決定
do-remove = この寸法を削除
do-go-on = 次へ
do-back = 戻る
do-stay = まだいます
do-still-me = 同じ本人です
do-begin-anew = 新しく始める
do-leave = 終わる（すべて消す）

# Parts of the body that are measured
part-stature = 身長
part-shoulders = 肩幅
part-chest = バスト
part-waist = ウエスト
part-hip = ヒップ
part-legs = 脚の長さ
list-and = { $first }と{ $last }
list-comma = { $first }、{ $last }
